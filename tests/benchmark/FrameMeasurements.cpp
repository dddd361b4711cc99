// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"
#include "Measurements.h"
#include "Scenes.h"

#include <osgGpuAnimation/looks/Environment.h>

#include <tiny_gltf.h>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr float pixelError = 0.5f;

/// hasBars: the bars are for this number of characters.
void addFrameRows(const Subject& subject, std::size_t count, bool hasBars, const std::vector<Costs>& costs,
                  Report& report)
{
    const double milliseconds = 1e3 / static_cast<double>(count);
    const auto row = [&](const char* what, const Costs& ours)
    { return Row(subject.name, count, what, "ms a character", ours.whole, milliseconds); };
    const Costs &ours = costs[0], &software = costs[1], &hardware = costs[2], &apart = costs[3], &fewer = costs[4];
    report.add(row("whole frame, 64x64", ours).fasterThan("osgAnimation hardware, a program each", apart.whole));
    const std::map<std::string, double> bars{{"Fox", 1.5}, {"CesiumMan", 6.0}, {"Knight", 3.0}};
    const bool isHardwareFaster = figureOf(hardware.whole).median < figureOf(software.whole).median;
    for (const bool isHardware : {!isHardwareFaster, isHardwareFaster}) // the faster mode has the bar
    {
        const Series& theirs = (isHardware ? hardware : software).whole;
        const std::string name = isHardware ? "osgAnimation hardware" : "osgAnimation software";
        Row against = row("whole frame, 64x64", ours).fasterThan(name, theirs);
        const auto bar = bars.find(subject.name);
        if (isHardware == isHardwareFaster && hasBars && bar != bars.end()) against.atLeast(bar->second);
        report.add(against);
        if (isHardware == isHardwareFaster)
            report.add(row("whole frame, 64x64, pixel error 0.5", fewer).fasterThan(name + ", all triangles", theirs));
    }
    report.add(row("whole frame, 64x64, pixel error 0.5", fewer).fasterThan("all triangles", ours.whole));
    if (hasBars)
        report.add(Row(subject.name, count, "update + cull, separate nodes", "µs a character", ours.updateAndCull,
                       1e3 * milliseconds)
                       .atMost(5.0));
}

/// Compares the pixels that levels of detail cover with those of all triangles, from four sides. The pictures, and the
/// pixel error with them, are 8 times as large as those that are measured: the levels and poses are the same, but a few
/// hundred pixels of which each character covers less than one would differ by a tenth and more by chance.
/// setPixelError: of fewer.
template <typename SetPixelError>
void requireAlike(osg::Node& all, osg::Node& fewer, SetPixelError setPixelError)
{
    constexpr int samples = 8, sides = 4;
    const osg::BoundingSphere sight = all.getBound();
    setPixelError(samples * pixelError);
    StagedViewer exact(&all, sight, samples * 64), reduced(&fewer, sight, samples * 64);
    const auto requireLess = [](int difference, double share, int pixels, const std::string& from)
    {
        if (pixels == 0 || std::abs(difference) > share * pixels)
            throw std::runtime_error("from " + from + " levels of detail show " + std::to_string(difference) +
                                     " pixels more than all triangles, which show " + std::to_string(pixels));
    };
    int pixelsOfAll = 0, difference = 0;
    for (int side = 0; side < sides; ++side)
    {
        const osg::Vec3d back = osg::Quat(osg::PI_2 * side, osg::Z_AXIS) * osg::Vec3d(0.9, -3.0, 2.4);
        for (StagedViewer* viewer : {&exact, &reduced})
        {
            viewer->lookFrom(sight.center() + back * sight.radius(), sight.center(), 35.0);
            viewer->frameAt(0.1);
            viewer->requireNoErrors();
        }
        const int pixels = exact.pixelsDrawn(), more = reduced.pixelsDrawn() - pixels;
        // In one pose and from one side, the coarsest levels are up to 17 % too thin or too wide.
        requireLess(more, 0.2, pixels, "side " + std::to_string(side));
        pixelsOfAll += pixels;
        difference += more;
    }
    requireLess(difference, 0.15, pixelsOfAll, "four sides"); // the Wanderer's coarsest levels are 11 % too thin
    setPixelError(pixelError);
}

/// The cost of the first frame of a scene, in CPU seconds.
struct Start
{
    double whole = 0.0;   ///< the nodes made, and the first frame
    double beyond = 0.0;  ///< the first frame alone beyond an ordinary frame
    double compile = 0.0; ///< a compile traversal before it
};

/// isCompiled: a compile traversal of OSG visits the scene before it is attached.
template <typename MakeScene>
Start start(MakeScene makeScene, const osg::BoundingSphere& sight, bool isCompiled = false)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    StagedViewer viewer(root, sight);
    viewer.frame();
    Start start;
    const Stopwatch stopwatch;
    const CharacterScene scene = makeScene();
    const Stopwatch compile;
    if (isCompiled) viewer.compile(*scene.root);
    start.compile = compile.elapsed().cpu;
    root->addChild(scene.root);
    const Stopwatch first;
    viewer.frame();
    start.whole = stopwatch.elapsed().cpu;
    start.beyond = first.elapsed().cpu;
    std::vector<double> ordinary;
    for (int frame = 0; frame < 5; ++frame)
        ordinary.push_back(viewer.frame().whole().cpu);
    start.beyond -= figureOf(ordinary).median;
    viewer.requireNoErrors();
    if (viewer.pixelsDrawn() < 4) throw std::runtime_error("an empty picture");
    return start;
}

/// The memory of so many characters on the CPU and the GPU after three frames, in bytes.
double footprint(const Subject& subject, std::size_t count, const osg::BoundingSphere& sight)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    StagedViewer viewer(root, sight);
    viewer.lookAside();
    viewer.frame();
    const double before = bytesInUse();
    const CharacterScene scene(subject, count);
    root->addChild(scene.root);
    for (int frame = 0; frame < 3; ++frame)
        viewer.frame();
    const double bytes = bytesInUse() - before;
    viewer.requireNoErrors();
    scene.check(viewer.currentState());
    return bytes;
}

} // namespace

void measureFrames(const Subject& subject, Run& run)
{
    const ReferenceKit kit(subject);
    for (const std::size_t count : run.frameCounts)
    {
        CharacterScene ours(subject, count), fewer(subject, count);
        fewer.setPixelError(pixelError);
        const ReferenceScene software(subject, kit, ReferenceMode::Software, count);
        const ReferenceScene hardware(subject, kit, ReferenceMode::Hardware, count);
        const ReferenceScene apart(subject, kit, ReferenceMode::HardwareApart, count);
        const Viewers viewers =
            viewersOf({ours.root, software.root, hardware.root, apart.root, fewer.root}, ours.root->getBound());
        const std::vector<Costs> costs = race(viewers, Run::frameRounds);
        requireAlike(*ours.root, *fewer.root, [&](float pixels) { fewer.setPixelError(pixels); });
        ours.check(viewers[0]->currentState());
        addFrameRows(subject, count, count == run.frameCount, costs, run.report);
    }
}

void measureCrowd(const Subject& subject, Run& run)
{
    const auto raced = [&](std::size_t count, int rounds, bool hasNodes)
    {
        const osg::ref_ptr<AnimatedCrowd> all = makeCrowd(subject, count), fewer = makeCrowd(subject, count);
        const auto setPixelError = [&](float pixels)
        {
            taken(fewer->getMeshes().setPixelError(pixels));
            fewer->getMeshes().waitForLevels();
        };
        setPixelError(pixelError);
        std::vector<osg::ref_ptr<osg::Node>> scenes{all, fewer};
        if (hasNodes) scenes.push_back(CharacterScene(subject, count).root);
        const Viewers viewers = viewersOf(scenes, all->getBound());
        std::vector<Costs> costs = race(viewers, rounds);
        requireAlike(*all, *fewer, setPixelError);
        return costs;
    };
    const std::vector<Costs> both = raced(run.frameCount, Run::frameRounds, true);
    run.report.add(Row(subject.name, run.frameCount, "whole frame of a crowd node", "ms a character", both[0].whole,
                       1e3 / static_cast<double>(run.frameCount))
                       .fasterThan("separate nodes", both[2].whole));
    const std::vector<Costs> large = raced(run.crowdCount, 1, false);
    const char* const names[] = {"update + cull, crowd", "update + cull, crowd, pixel error 0.5"};
    for (std::size_t i = 0; i < large.size(); ++i)
        run.report.add(Row(subject.name, run.crowdCount, names[i], "µs a character", large[i].updateAndCull,
                           1e6 / static_cast<double>(run.crowdCount))
                           .atMost(0.15));
}

void measureStart(const Subject& subject, Run& run)
{
    constexpr std::size_t count = 1000, few = 10; // few: the one-time cost of programs and of the set
    const auto makeAll = [&] { return CharacterScene(subject, count); };
    const auto makeFewer = [&]
    {
        CharacterScene scene(subject, count);
        scene.setPixelError(pixelError);
        return scene;
    };
    const osg::BoundingSphere sight = makeAll().root->getBound();
    CharacterScene(subject, 1).setPixelError(pixelError); // the levels of detail are made
    std::vector<double> whole, wholeOfFewer, beyond, beyondOfFewer, compile, beyondCompiled, bytes;
    for (int round = 0; round < Run::frameRounds; ++round)
    {
        const Start all = start(makeAll, sight), fewer = start(makeFewer, sight),
                    compiled = start(makeAll, sight, true);
        whole.push_back(all.whole);
        wholeOfFewer.push_back(fewer.whole);
        beyond.push_back(1e3 * all.beyond);
        beyondOfFewer.push_back(1e3 * fewer.beyond);
        compile.push_back(1e3 * compiled.compile);
        beyondCompiled.push_back(1e3 * compiled.beyond);
        bytes.push_back((footprint(subject, count, sight) - footprint(subject, few, sight)) / (1024.0 * (count - few)));
    }
    const auto row = [&](const char* what, const char* unit, const std::vector<double>& values)
    { return Row(subject.name, count, what, unit, figureOf(values)); };
    run.report.add(row("first frame, nodes made and drawn", "s", whole).atMost(0.3));
    run.report.add(row("first frame, nodes made and drawn, pixel error 0.5", "s", wholeOfFewer).atMost(0.3));
    run.report.add(row("first frame beyond an ordinary one", "ms", beyond));
    run.report.add(row("first frame beyond an ordinary one, pixel error 0.5", "ms", beyondOfFewer));
    run.report.add(row("compile traversal", "ms", compile));
    run.report.add(row("first frame after a compile traversal, beyond an ordinary one", "ms", beyondCompiled));
    // 4 KiB and 48 bytes an entry
    run.report.add(row("memory, CPU and GPU", "KiB a character", bytes)
                       .atMost(4.0 + 48.0 * static_cast<double>(subject.set().paletteSize()) / 1024.0));
}

void measureDraws(const Subject& subject, Run& run)
{
    const std::size_t count = run.frameCount;
    CharacterScene ours(subject, count);
    ours.pause(); // palettes stay valid, so that only the draws are measured
    const Viewers viewers = viewersOf({ours.root, makeUnskinnedScene(subject, count, Shading::AsCharacters),
                                       makeUnskinnedScene(subject, count, Shading::Least)},
                                      ours.root->getBound());
    const std::vector<Costs> costs = race(viewers, run.rounds);
    const Row skinned(subject.name, count, "skinned draw", "µs a character", costs[0].draw,
                      1e6 / static_cast<double>(count));
    run.report.add(Row(skinned).against("the same without skinning", costs[1].draw).atMost(1.6));
    run.report.add(Row(skinned).against("the same triangles in one colour", costs[2].draw));
}

void measureShading(const Subject& subject, Run& run)
{
    std::vector<Subject> subjects;
    for (const bool isFixed : {true, false, false})
    {
        subjects.push_back(taken(loadSubject(subject.fileName, isFixed)));
        subjects.back().model.character->getController().pause();
    }
    const Subject &fixed = subjects[0], &lit = subjects[1], &inStudio = subjects[2];
    const osg::ref_ptr<Environment> studio = new Environment;
    studio->setToneMapping(true);
    studio->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::OFF);
    studio->addChild(inStudio.model.root);
    osg::BoundingSphere sight = fixed.model.root->getBound();
    sight.radius() *= 0.2f;   // the character fills the picture
    constexpr int side = 512; // pixels: fragments, not vertices, decide the cost
    Viewers closeUps;
    for (const osg::ref_ptr<osg::Node>& scene :
         std::vector<osg::ref_ptr<osg::Node>>{fixed.model.root, lit.model.root, studio})
        closeUps.push_back(std::make_unique<StagedViewer>(scene, sight, side));

    std::vector<osg::ref_ptr<osg::Node>> crowds;
    for (const Subject* each : {&fixed, &lit})
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(*each, run.crowdCount);
        taken(crowd->getMeshes().setPixelError(fieldPixelError));
        crowd->getMeshes().waitForLevels();
        crowds.push_back(crowd);
    }
    const std::vector<Costs> close = race(closeUps, run.rounds);
    const std::vector<Costs> far = race(viewersOf(crowds, crowds[0]->getBound()), run.rounds);

    const char* const other = "the fixed pipeline's look";
    const auto closeUp = [&](const char* what, const Costs& costs)
    { return Row(subject.name, 1, what, "ns a pixel", costs.draw, 1e9 / (side * side)).against(other, close[0].draw); };
    run.report.add(closeUp("shading, one light", close[1]).atMost(1.8));
    run.report.add(closeUp("shading, studio", close[2]).atMost(2.5));
    run.report.add(Row(subject.name, run.crowdCount, "whole frame of a crowd node, pixel error 0.5", "ms a character",
                       far[1].whole, 1e3 / static_cast<double>(run.crowdCount))
                       .against(other, far[0].whole)
                       .atMost(1.15));
}

void measureLoad(const Subject& subject, Run& run)
{
    // From the file name to the OSG graph that is ready to be drawn.
    const auto loadOurs = [&]
    {
        const Stopwatch stopwatch;
        const std::string bytes = taken(gltf::readModelFile(subject.fileName, {}));
        const gltf::ImportedModel model = taken(gltf::importModel(bytes, subject.fileName, {}));
        return stopwatch.elapsed();
    };
    // Parsing and image decoding alone, with tinygltf's defaults.
    const auto loadByTinyGltf = [&]
    {
        const Stopwatch stopwatch;
        tinygltf::TinyGLTF loader;
        tinygltf::Model model;
        std::string error, warning;
        const bool isLoaded = loader.LoadBinaryFromFile(&model, &error, &warning, subject.fileName);
        const Spent spent = stopwatch.elapsed();
        if (!isLoaded) throw std::runtime_error("tinygltf: " + error);
        return spent;
    };
    const std::vector<Series> series = interleaved(run.loadRounds, {loadOurs, loadByTinyGltf});
    run.report.add(Row(subject.name, 1, "load, from the file to the OSG graph", "ms", series[0], 1e3)
                       .against("tinygltf's parse and image decode alone", series[1])
                       .atMost(1.5));
}

} // namespace osgGpuAnimation::benchmark
