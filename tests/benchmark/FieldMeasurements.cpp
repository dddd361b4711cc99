// SPDX-License-Identifier: MIT
#include "Contestant.h"
#include "Measurements.h"
#include "Scenes.h"

#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <random>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr std::size_t columns = 316; ///< and as many rows
constexpr float pixelError = 0.5f;

/// Of neighbours, in the units of the subject's file.
double spacingOf(const Subject& subject)
{
    const std::map<std::string, double> known{{"Fox", 110.0}, {"CesiumMan", 1.1}, {"Knight", 2.2}, {"Wanderer", 1.1}};
    return known.at(subject.name);
}

/// Everybody loops some clip of the file from some time on.
osg::ref_ptr<AnimatedCrowd> makeField(const Subject& subject)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*subject.model.character);
    std::mt19937 random(1);
    for (std::size_t place = 0; place < columns * columns; ++place)
    {
        AnimationController controller(crowd->getSharedAnimationSet());
        static_cast<void>(controller.play(random() % subject.set().clips().size()));
        controller.seek(phaseOf(place, controller.duration()));
        const double x = spacingOf(subject) * static_cast<double>(place % columns);
        const double y = spacingOf(subject) * static_cast<double>(place / columns);
        static_cast<void>(crowd->add(osg::Matrixd::translate(x, y, 0.0), controller));
    }
    return crowd;
}

/// What the context has evaluated and uploaded so far.
struct Counts
{
    explicit Counts(StagedViewer& viewer)
    {
        viewer.makeCurrent();
        const PosePipeline::Counters& counters = PosePipeline::of(viewer.state())->getCounters();
        poses = static_cast<double>(counters.instancesEvaluated);
        bytes =
            static_cast<double>(counters.bytesUploaded + PlacedInstanceBuffers::of(viewer.state()).getBytesUploaded());
    }

    double poses, bytes;
};

} // namespace

Result<bool> measureField(const Subject& subject, const Effort& effort, Report& report)
{
    std::cerr << subject.name << ": a field of " << columns * columns << std::endl;
    const osg::ref_ptr<AnimatedCrowd> field = makeField(subject);
    if (const Result<bool> set = field->setPixelError(pixelError); !set) return set.error();
    const osg::BoundingSphere bound = field->getBound();
    Result<Contestant> made = contestant(field, bound, 1280, 720);
    if (!made) return made.error();
    std::vector<Contestant> contestants{std::move(made.value())};
    StagedViewer& viewer = *contestants.front().viewer;
    const osg::Vec3d centre = bound.center();
    viewer.lookFrom(centre + osg::Vec3d(0.0, -0.74, 0.06) * bound.radius(), centre, 30.0);
    race(contestants, effort.rounds);
    if (const std::string wrong = check(contestants); !wrong.empty()) return Error{wrong};
    const Counts before(viewer);
    contestants.front().frame();
    const Counts after(viewer);
    const double count = static_cast<double>(columns * columns);
    const auto addRow = [&](const char* what, const char* unit, std::vector<double> values)
    {
        Row row = named({}, subject, columns * columns, what, unit, "");
        row.ours = figureOf(std::move(values));
        report.add(row);
    };
    const auto microseconds = [&](const Series& series)
    {
        std::vector<double> each;
        for (const Spent& spent : series)
            each.push_back(1e6 * spent.cpu / count);
        return each;
    };
    addRow("the field, whole frame", "µs an instance", microseconds(contestants.front().whole));
    addRow("the field, update + cull", "µs an instance", microseconds(contestants.front().updateAndCull));
    addRow("the field, poses evaluated", "a frame", {after.poses - before.poses});
    addRow("the field, uploaded", "bytes an instance", {(after.bytes - before.bytes) / count});
    return true;
}

} // namespace osgGpuAnimation::benchmark
