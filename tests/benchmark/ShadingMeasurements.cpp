// SPDX-License-Identifier: MIT
#include "Contestant.h"
#include "Measurements.h"
#include "Scenes.h"

#include <osgGpuAnimation/looks/Environment.h>

#include <iostream>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr int side = 512; // pixels: fragments, not vertices, decide the cost

/// Contestants: the fixed pipeline's look, one light and the even surrounding, the studio; in a picture that the
/// character fills.
Result<std::vector<Contestant>> closeUps(const Subject& fixed, const Subject& lit, const Subject& inStudio)
{
    const osg::ref_ptr<Environment> studio = new Environment;
    studio->setToneMapping(true);
    studio->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::OFF);
    studio->addChild(inStudio.model.root);
    osg::BoundingSphere sight = fixed.model.root->getBound();
    sight.radius() *= 0.2f;
    std::vector<Contestant> contestants;
    for (osg::Group* scene : {fixed.model.root.get(), lit.model.root.get(), static_cast<osg::Group*>(studio.get())})
    {
        Result<Contestant> made = contestant(scene, sight, side);
        if (!made) return made.error();
        contestants.push_back(std::move(made.value()));
    }
    return contestants;
}

/// Contestants: crowds in the fixed pipeline's look, and with one light and the even surrounding.
Result<std::vector<Contestant>> crowds(const Subject& fixed, const Subject& lit, std::size_t count)
{
    std::vector<Contestant> contestants;
    for (const Subject* subject : {&fixed, &lit})
    {
        const CrowdScene scene(*subject, count);
        if (const Result<void> set = scene.root->getMeshes().setPixelError(0.5f); !set) return set.error();
        Result<Contestant> made = contestant(scene.root, scene.root->getBound());
        if (!made) return made.error();
        contestants.push_back(std::move(made.value()));
    }
    return contestants;
}

} // namespace

Result<void> measureShading(const Subject& subject, const Effort& effort, Report& report)
{
    std::cerr << subject.name << ": shading" << std::endl;
    std::vector<Subject> subjects;
    for (const bool isFixed : {true, false, false})
    {
        Result<Subject> loaded = loadSubject(subject.name, subject.fileName, isFixed);
        if (!loaded) return loaded.error();
        subjects.push_back(loaded.value());
        subjects.back().model.character->getController().pause();
    }
    const Result<std::vector<Contestant>> near = closeUps(subjects[0], subjects[1], subjects[2]);
    if (!near) return near.error();
    const Result<std::vector<Contestant>> far = crowds(subjects[0], subjects[1], effort.crowdCount);
    if (!far) return far.error();
    std::vector<Contestant> close = near.value(), crowd = far.value();
    for (std::vector<Contestant>* contestants : {&close, &crowd})
    {
        race(*contestants, effort.rounds);
        if (const std::string wrong = check(*contestants); !wrong.empty()) return Error{wrong};
    }
    constexpr double nanosecondsAPixel = 1e9 / (side * side);
    const double milliseconds = 1e3 / static_cast<double>(effort.crowdCount);
    const struct
    {
        const char *name, *unit, *bar;
        double most;
        Row row;
    } rows[] = {{"shading, one light", "ns a pixel", "≤ 1.8", 1.8,
                 compared(close[1].draw, close[0].draw, nanosecondsAPixel, false)},
                {"shading, studio", "ns a pixel", "≤ 2.5", 2.5,
                 compared(close[2].draw, close[0].draw, nanosecondsAPixel, false)},
                {"whole frame of a crowd node, pixel error 0.5", "ms a character", "≤ 1.15", 1.15,
                 compared(crowd[1].whole, crowd[0].whole, milliseconds, false)}};
    for (const auto& each : rows)
    {
        Row row = named(each.row, subject, &each == &rows[2] ? effort.crowdCount : 1, each.name, each.unit,
                        "the fixed pipeline's look");
        row.bar = each.bar;
        row.isMet = row.ratio.median <= each.most;
        report.add(row);
    }
    return {};
}

} // namespace osgGpuAnimation::benchmark
