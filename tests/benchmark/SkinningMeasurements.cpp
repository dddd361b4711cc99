// SPDX-License-Identifier: MIT
#include "Contestant.h"
#include "Measurements.h"
#include "Scenes.h"

#include <osgGpuAnimation/nodes/CharacterProgram.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Camera>

#include <algorithm>
#include <iostream>

namespace osgGpuAnimation::benchmark
{

namespace
{

/// The scene as so many cameras see it, all from where the viewer's is.
osg::ref_ptr<osg::Group> seenBy(std::size_t readers, osg::Node* scene)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene);
    for (std::size_t reader = 1; reader < readers; ++reader)
    {
        osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setRenderOrder(osg::Camera::POST_RENDER);
        camera->setClearMask(GL_DEPTH_BUFFER_BIT);
        camera->addChild(scene);
        root->addChild(camera);
    }
    return root;
}

/// Clones share their meshes.
template <typename Function>
void forEachMesh(const CharacterScene& scene, Function function)
{
    const osg::Group& character = *scene.characters.front();
    for (unsigned int child = 0; child < character.getNumChildren(); ++child)
        if (auto* mesh = dynamic_cast<SkinnedGeometry*>(const_cast<osg::Node*>(character.getChild(child))))
            function(*mesh);
}

/// Gives all meshes so many morph targets that move next to nothing; as weights serve the twelve numbers of a joint's
/// matrix, since the set has none.
void setMorphTargets(const CharacterScene& scene, std::size_t count)
{
    const auto set = [&](SkinnedGeometry& mesh)
    {
        std::vector<MorphTarget> targets(count);
        for (MorphTarget& target : targets)
        {
            target.positions =
                new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned>(mesh.vertexCount()));
            std::fill(target.positions->begin(), target.positions->end(), osg::Vec3(1e-6f, 0.0f, 0.0f));
            target.normals = target.positions;
        }
        mesh.setMorphTargets(0, 0, std::move(targets));
        applySkinDefines(*mesh.getOrCreateStateSet(), mesh.influenceCount(), count > 0);
    };
    forEachMesh(scene, set);
}

/// By turns: frames in which the same is skinned by every draw, and once for all.
Result<bool> measureOnce(const Subject& subject, std::size_t count, std::size_t readers, std::size_t morphTargets,
                         int rounds, Report& report)
{
    std::vector<Contestant> contestants;
    std::vector<Series> series(2);
    CharacterScene scene(subject, count);
    setMorphTargets(scene, morphTargets);
    const osg::ref_ptr<osg::Group> root = seenBy(readers, scene.root);
    Result<Contestant> made = contestant(root, scene.root->getBound());
    if (!made) return made.error();
    contestants.push_back(std::move(made.value()));
    for (int round = -1; round < rounds; ++round)
        for (const Skinning skinning : {Skinning::EveryDraw, Skinning::Once})
        {
            forEachMesh(scene, [&](SkinnedGeometry& mesh) { mesh.setSkinning(skinning); });
            // The plan follows what was asked for with the frame after the next.
            for (int frame = 0; frame < 2; ++frame)
                contestants[0].frame();
            const Spent spent = contestants[0].frame().draw;
            if (round >= 0) series[skinning == Skinning::Once ? 1 : 0].push_back(spent);
        }
    // The subject's other scenes have the same meshes.
    forEachMesh(scene, [](SkinnedGeometry& mesh) { mesh.setSkinning(Skinning::Auto); });
    if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
    const std::string what = "frame's draws, " + std::to_string(readers) + (readers == 1 ? " camera" : " cameras") +
                             (morphTargets == 0 ? "" : ", morph targets: " + std::to_string(morphTargets));
    setMorphTargets(scene, 0);
    report.add(named(compared(series[1], series[0], 1e6 / static_cast<double>(count), true), subject, count, what,
                     "µs a character, skinned once", "skinned by every draw"));
    return true;
}

} // namespace

Result<bool> measureDraws(const Subject& subject, const Effort& effort, Report& report)
{
    std::cerr << subject.name << ": draws" << std::endl;
    const std::size_t count = effort.frameCount;
    CharacterScene ours(subject, count);
    CharacterScene apart(subject, count);
    for (CharacterScene* scene : {&ours, &apart})
        scene->pause(); // palettes stay, so that nothing but the draws is left
    for (const osg::ref_ptr<AnimatedCharacter>& character : apart.characters)
        character->setDrawnTogether(false);
    const osg::ref_ptr<osg::Group> plain = makeUnskinnedScene(subject, count, Shading::AsCharacters);
    const osg::ref_ptr<osg::Group> least = makeUnskinnedScene(subject, count, Shading::Least);
    std::vector<Contestant> contestants;
    for (const osg::ref_ptr<osg::Group>& scene : {ours.root, plain, apart.root, least})
    {
        Result<Contestant> made = contestant(scene, ours.root->getBound());
        if (!made) return made.error();
        contestants.push_back(std::move(made.value()));
    }
    race(contestants, effort.rounds);
    if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
    Row row = named(compared(contestants[0].draw, contestants[1].draw, 1e6 / static_cast<double>(count), false),
                    subject, count, "skinned draw", "µs a character", "the same without skinning");
    row.bar = "≤ 1.6";
    row.isMet = row.ratio.median <= 1.6;
    report.add(row);
    report.add(named(compared(contestants[2].draw, contestants[1].draw, 1e6 / static_cast<double>(count), false),
                     subject, count, "skinned draw, one by one", "µs a character", "the same without skinning"));
    report.add(named(compared(contestants[0].draw, contestants[3].draw, 1e6 / static_cast<double>(count), false),
                     subject, count, "skinned draw", "µs a character", "the same triangles in one colour"));
    return true;
}

Result<bool> measureSkinning(const Subject& subject, const Effort& effort, Report& report)
{
    std::cerr << subject.name << ": skinning once" << std::endl;
    for (const std::size_t characters : effort.onceCounts)
    {
        const bool areFew = characters == effort.onceCounts.front();
        for (const std::size_t targets : areFew ? std::vector<std::size_t>{0, 1, 2, 4, 8} : std::vector<std::size_t>{0})
            for (const std::size_t readers : {1, 2, 3, 4})
                if (const Result<bool> done = measureOnce(subject, characters, readers, targets,
                                                          areFew ? effort.rounds : effort.frameRounds, report);
                    !done)
                    return done;
    }
    return true;
}

} // namespace osgGpuAnimation::benchmark
