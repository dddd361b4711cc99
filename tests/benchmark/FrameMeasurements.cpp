// SPDX-License-Identifier: MIT
#include "Contestant.h"
#include "Measurements.h"
#include "Scenes.h"

#include <algorithm>
#include <iostream>
#include <map>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr float pixelError = 0.5f;

/// One plot per subject.
std::string framePlot(const Subject& subject)
{
    return "frame-over-n-" + subject.name + ".svg";
}

double frameBar(const Subject& subject)
{
    const std::map<std::string, double> bars{{"Fox", 1.5}, {"CesiumMan", 6.0}, {"Knight", 3.0}};
    const auto known = bars.find(subject.name);
    return known == bars.end() ? 0.0 : known->second;
}

void addFrameRows(const Subject& subject, std::size_t count, const std::vector<Contestant>& contestants,
                  const Effort& effort, Report& report)
{
    const double characters = static_cast<double>(count);
    const double milliseconds = 1e3 / characters;
    const char* names[] = {"osgGpuAnimation", "osgAnimation software", "osgAnimation hardware",
                           "osgAnimation hardware, a program each", "osgGpuAnimation, pixel error 0.5"};
    for (std::size_t i = 0; i < contestants.size(); ++i)
        report.addPoint(framePlot(subject), names[i], characters, cpuOf(contestants[i].whole).median * milliseconds);
    if (count != effort.frameCount) return;
    report.add(named(compared(contestants[0].whole, contestants[3].whole, milliseconds, true), subject, count,
                     "whole frame, 64x64", "ms a character", "osgAnimation hardware, a program each"));
    const bool isHardwareBetter = cpuOf(contestants[2].whole).median < cpuOf(contestants[1].whole).median;
    const Contestant& better = contestants[isHardwareBetter ? 2 : 1];
    const char* name = isHardwareBetter ? "osgAnimation hardware" : "osgAnimation software";
    Row row = named(compared(contestants[0].whole, better.whole, milliseconds, true), subject, count,
                    "whole frame, 64x64", "ms a character", name);
    if (frameBar(subject) > 0.0)
    {
        row.bar = frameBar(subject) == 1.5 ? "≥ 1.5" : frameBar(subject) == 6.0 ? "≥ 6" : "≥ 3";
        row.isMet = row.ratio.median >= frameBar(subject);
    }
    report.add(row);
    for (const bool isAgainstOurs : {false, true})
        report.add(named(
            compared(contestants[4].whole, isAgainstOurs ? contestants[0].whole : better.whole, milliseconds, true),
            subject, count, "whole frame, 64x64, pixel error 0.5", "ms a character",
            isAgainstOurs ? "all triangles" : (std::string(name) + ", all triangles").c_str()));
    row = named({}, subject, count, "update + cull, separate nodes, pixel error 0.5", "µs a character", "");
    row.ours = compared(contestants[4].updateAndCull, better.updateAndCull, 1e6 / characters, true).ours;
    row.bar = "ours ≤ 5 µs";
    row.isMet = row.ours.median <= 5.0;
    report.add(row);
    row = named(compared(contestants[0].updateAndCull, better.updateAndCull, 1e6 / characters, true), subject, count,
                "update + cull, separate nodes", "µs a character", name);
    row.bar = "ours ≤ 5 µs";
    row.isMet = row.ours.median <= 5.0;
    report.add(row);
}

/// Compares the pixels that levels of detail cover with those of all triangles, from four sides. The pictures, and the
/// pixel error with them, are 8 times as large as those that are measured: the levels and poses are the same, but a few
/// hundred pixels of which each character covers less than one would differ by a tenth and more by chance.
/// setPixelError: of fewer. Empty if they agree.
template <typename SetPixelError>
std::string checkAlike(osg::Node& all, osg::Node& fewer, SetPixelError setPixelError)
{
    constexpr int samples = 8, sides = 4;
    const osg::BoundingSphere sight = all.getBound();
    if (const Result<void> set = setPixelError(samples * pixelError); !set) return set.error().message;
    std::vector<std::shared_ptr<StagedViewer>> viewers;
    for (osg::Node* scene : {&all, &fewer})
    {
        Result<std::shared_ptr<StagedViewer>> made = StagedViewer::create(scene, sight, samples * 64);
        if (!made) return made.error().message;
        viewers.push_back(std::move(made.value()));
    }
    int ofAll = 0, ofFewer = 0;
    for (int side = 0; side < sides; ++side)
    {
        const osg::Vec3d back = osg::Quat(osg::PI_2 * side, osg::Z_AXIS) * osg::Vec3d(0.9, -3.0, 2.4);
        int pixels[2];
        for (std::size_t i = 0; i < 2; ++i)
        {
            viewers[i]->lookFrom(sight.center() + back * sight.radius(), sight.center(), 35.0);
            viewers[i]->frame(0.1);
            if (const std::string errors = viewers[i]->takeErrors(); !errors.empty()) return "GL reports " + errors;
            pixels[i] = viewers[i]->pixelsDrawn();
        }
        ofAll += pixels[0];
        ofFewer += pixels[1];
        // In one pose and from one side, the coarsest levels are up to 17 % too thin or too wide.
        if (5 * std::abs(pixels[0] - pixels[1]) > pixels[0])
            return "from side " + std::to_string(side) + " levels of detail show " + std::to_string(pixels[1]) +
                   " pixels, all triangles " + std::to_string(pixels[0]);
    }
    if (const Result<void> set = setPixelError(pixelError); !set) return set.error().message;
    // The Wanderer's coarsest levels are 11 % too thin.
    if (20 * std::abs(ofAll - ofFewer) <= 3 * ofAll && ofAll > 0) return "";
    return "from " + std::to_string(sides) + " sides levels of detail show " + std::to_string(ofFewer) +
           " pixels, all triangles " + std::to_string(ofAll);
}

/// The cost of the first frame of a scene.
struct Start
{
    Spent spent;          ///< the nodes made, and the first frame
    double beyond = 0.0;  ///< CPU seconds of the first frame alone beyond an ordinary frame
    double compile = 0.0; ///< CPU seconds of the compile traversal before it; 0: none
    int pixels = 0;       ///< that differ from the background
};

/// isCompiled: a compile traversal of OSG visits the scene before it is attached.
template <typename MakeScene>
Result<Start> start(MakeScene makeScene, const osg::BoundingSphere& sight, bool isCompiled = false)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    Result<Contestant> made = contestant(root, sight);
    if (!made) return made.error();
    Contestant viewing = made.value();
    viewing.frame();
    Start start;
    const Stopwatch stopwatch;
    auto scene = makeScene();
    const Stopwatch compile;
    if (isCompiled) viewing.viewer->compile(*scene.root);
    if (isCompiled) start.compile = compile.elapsed().cpu;
    root->addChild(scene.root);
    const Stopwatch first;
    viewing.frame();
    start.spent = stopwatch.elapsed();
    start.beyond = first.elapsed().cpu;
    std::vector<double> ordinary;
    for (int frame = 0; frame < 5; ++frame)
        ordinary.push_back(viewing.frame().whole().cpu);
    start.beyond -= figureOf(ordinary).median;
    if (const std::string errors = viewing.viewer->takeErrors(); !errors.empty()) return Error{errors};
    start.pixels = viewing.viewer->pixelsDrawn();
    return start;
}

/// The memory of a scene on the CPU and the GPU after three frames, in bytes.
template <typename MakeScene>
Result<double> footprint(MakeScene makeScene, const osg::BoundingSphere& sight)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    Result<Contestant> made = contestant(root, sight);
    if (!made) return made.error();
    Contestant viewing = made.value();
    viewing.viewer->lookAside();
    viewing.frame();
    const double before = bytesInUse();
    auto scene = makeScene();
    root->addChild(scene.root);
    for (int frame = 0; frame < 3; ++frame)
        viewing.frame();
    const double bytes = bytesInUse() - before;
    if (const std::string errors = viewing.viewer->takeErrors(); !errors.empty()) return Error{errors};
    if (const std::string wrong = scene.check(viewing.viewer->state()); !wrong.empty()) return Error{wrong};
    return bytes;
}

} // namespace

Result<void> measureFrames(const Subject& subject, const Effort& effort, Report& report)
{
    report.describePlot(framePlot(subject), subject.name + ", whole frame at 64x64: CPU time a character", "characters",
                        "ms a character");
    ReferenceKit kit(subject);
    for (const std::size_t count : effort.frameCounts)
    {
        std::cerr << subject.name << ": frames of " << count << std::endl;
        CharacterScene ours(subject, count);
        ReferenceScene software(subject, kit, ReferenceMode::Software, count);
        ReferenceScene hardware(subject, kit, ReferenceMode::Hardware, count);
        ReferenceScene apart(subject, kit, ReferenceMode::HardwareApart, count);
        std::vector<Contestant> contestants;
        CharacterScene fewer(subject, count);
        if (const Result<void> set = fewer.setPixelError(pixelError); !set) return set.error();
        for (osg::Node* scene :
             {ours.root.get(), software.root.get(), hardware.root.get(), apart.root.get(), fewer.root.get()})
        {
            Result<Contestant> made = contestant(scene, ours.root->getBound());
            if (!made) return made.error();
            contestants.push_back(std::move(made.value()));
        }
        race(contestants, effort.frameRounds);
        if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
        const auto setPixelError = [&](float pixels) { return fewer.setPixelError(pixels); };
        if (const std::string wrong = checkAlike(*ours.root, *fewer.root, setPixelError); !wrong.empty())
            return Error{wrong};
        contestants[0].viewer->makeCurrent();
        if (const std::string wrong = ours.check(contestants[0].viewer->state()); !wrong.empty()) return Error{wrong};
        addFrameRows(subject, count, contestants, effort, report);
    }
    return {};
}

Result<void> measureCrowd(const Subject& subject, const Effort& effort, Report& report)
{
    const auto race = [&](std::size_t count, int rounds, bool hasNodes) -> Result<std::vector<Contestant>>
    {
        std::cerr << subject.name << ": a crowd of " << count << std::endl;
        const CrowdScene all(subject, count), fewer(subject, count);
        const auto setPixelError = [&](float pixels) { return fewer.root->getMeshes().setPixelError(pixels); };
        if (const Result<void> set = setPixelError(pixelError); !set) return set.error();
        std::vector<osg::ref_ptr<osg::Node>> scenes{all.root, fewer.root};
        if (hasNodes) scenes.push_back(CharacterScene(subject, count).root);
        std::vector<Contestant> contestants;
        for (const osg::ref_ptr<osg::Node>& scene : scenes)
        {
            Result<Contestant> made = contestant(scene, scenes.front()->getBound());
            if (!made) return made.error();
            contestants.push_back(std::move(made.value()));
        }
        benchmark::race(contestants, rounds);
        if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
        if (const std::string wrong = checkAlike(*all.root, *fewer.root, setPixelError); !wrong.empty())
            return Error{wrong};
        return contestants;
    };
    const Result<std::vector<Contestant>> both = race(effort.frameCount, effort.frameRounds, true);
    if (!both) return both.error();
    const double characters = static_cast<double>(effort.frameCount);
    report.add(named(compared(both.value()[0].whole, both.value()[2].whole, 1e3 / characters, true), subject,
                     effort.frameCount, "whole frame of a crowd node", "ms a character", "separate nodes"));
    const Result<std::vector<Contestant>> large = race(effort.crowdCount, 1, false);
    if (!large) return large.error();
    for (const auto& [count, contestants] :
         {std::pair(effort.frameCount, &both.value()), std::pair(effort.crowdCount, &large.value())})
        report.add(
            named(compared((*contestants)[1].whole, (*contestants)[0].whole, 1e3 / static_cast<double>(count), true),
                  subject, count, "whole frame of a crowd node, pixel error 0.5", "ms a character", "all triangles"));
    for (const std::size_t which : {std::size_t(0), std::size_t(1)})
    {
        Row row =
            named({}, subject, effort.crowdCount,
                  which == 0 ? "update + cull, crowd" : "update + cull, crowd, pixel error 0.5", "µs a character", "");
        std::vector<double> seconds;
        for (const Spent& spent : large.value()[which].updateAndCull)
            seconds.push_back(1e6 * spent.cpu / static_cast<double>(effort.crowdCount));
        row.ours = figureOf(seconds);
        row.bar = "≤ 0.15 µs";
        row.isMet = row.ours.median <= 0.15;
        report.add(row);
    }
    return {};
}

Result<void> measureStart(const Subject& subject, const Effort& effort, Report& report)
{
    std::cerr << subject.name << ": first frame and memory" << std::endl;
    constexpr std::size_t count = 1000, few = 10; // few: the one-time cost of programs and of the set
    const osg::BoundingSphere sight = CharacterScene(subject, count).root->getBound();
    // Levels of detail are made while a file is loaded.
    if (const Result<void> set = CharacterScene(subject, 1).setPixelError(pixelError); !set)
        return set.error();
    std::vector<double> seconds, secondsOfFewer, elapsed, bytes, beyond, beyondOfFewer, compiled, beyondCompiled;
    for (int round = 0; round < std::min(effort.frameRounds, 3); ++round)
    {
        const Result<Start> many = start([&] { return CharacterScene(subject, count); }, sight);
        const Result<Start> fewer = start(
            [&]
            {
                CharacterScene scene(subject, count);
                static_cast<void>(scene.setPixelError(pixelError)); // which was accepted above
                return scene;
            },
            sight);
        const Result<Start> prepared = start([&] { return CharacterScene(subject, count); }, sight, true);
        if (!many || !fewer) return many ? fewer.error() : many.error();
        if (!prepared) return prepared.error();
        const Result<double> ofMany = footprint([&] { return CharacterScene(subject, count); }, sight);
        const Result<double> ofFew = footprint([&] { return CharacterScene(subject, few); }, sight);
        if (!ofMany || !ofFew) return ofMany ? ofFew.error() : ofMany.error();
        if (many.value().pixels < 4 || fewer.value().pixels < 4) return Error{"an empty picture"};
        seconds.push_back(many.value().spent.cpu);
        elapsed.push_back(many.value().spent.wall);
        secondsOfFewer.push_back(fewer.value().spent.cpu);
        beyond.push_back(1e3 * many.value().beyond);
        beyondOfFewer.push_back(1e3 * fewer.value().beyond);
        compiled.push_back(1e3 * prepared.value().compile);
        beyondCompiled.push_back(1e3 * prepared.value().beyond);
        bytes.push_back((ofMany.value() - ofFew.value()) / (1024.0 * (count - few)));
    }
    for (const auto& [what, figures] :
         {std::pair("first frame, nodes made and drawn", &seconds),
          std::pair("first frame, nodes made and drawn, by the clock", &elapsed),
          std::pair("first frame, nodes made and drawn, pixel error 0.5", &secondsOfFewer)})
        report.add(limited(figureOf(*figures), 0.3, "≤ 0.3 s", subject, count, what, "s"));
    for (const auto& [what, figures] :
         {std::pair("first frame beyond an ordinary one", &beyond),
          std::pair("first frame beyond an ordinary one, pixel error 0.5", &beyondOfFewer),
          std::pair("compile traversal", &compiled),
          std::pair("first frame after a compile traversal, beyond an ordinary one", &beyondCompiled)})
        report.add(limited(figureOf(*figures), 0.0, "", subject, count, what, "ms"));
    const double limit = 4.0 + 48.0 * static_cast<double>(subject.set().paletteSize()) / 1024.0;
    report.add(limited(figureOf(bytes), limit, "≤ 4 KiB + 48 B an entry", subject, count, "memory, CPU and GPU",
                       "KiB a character"));
    return {};
}

} // namespace osgGpuAnimation::benchmark
