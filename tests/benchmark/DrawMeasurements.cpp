// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "Scenes.h"

#include <osgGpuAnimation/looks/Environment.h>

namespace osgGpuAnimation::benchmark
{

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

} // namespace osgGpuAnimation::benchmark
