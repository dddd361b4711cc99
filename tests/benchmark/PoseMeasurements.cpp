// SPDX-License-Identifier: MIT
#include "ChainSet.h"
#include "Measurements.h"
#include "PoseCrowd.h"
#include "Scenes.h"
#include "StagedViewer.h"

#include <iostream>
#include <map>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr const char* posePlot = "pose-over-n.svg";
constexpr const char* depthPlot = "pose-over-depth.svg";
constexpr double frameTime = 1.0 / 60.0;

/// The times for one number of a subject's characters.
struct PoseSeries
{
    Series ours, floor, triangleFloor, bones, hardware;
};

Result<PoseSeries> poseSeries(const Subject& subject, ReferenceKit& kit, std::size_t count, const Effort& effort,
                              osg::GraphicsContext& context)
{
    PoseCrowd crowd(subject.model.set, subject.clip, count, context);
    const std::size_t matrices = subject.set().paletteSize() * count;
    FeedbackFloor floor(matrices, FeedbackFloor::Primitive::Points, context);
    FeedbackFloor triangleFloor(matrices, FeedbackFloor::Primitive::Triangles, context);
    std::vector<std::function<Spent()>> contestants{[&] { return crowd.step(frameTime); }};

    std::unique_ptr<ReferenceScene> bones, hardware;
    double time = 0.0;
    const auto updating = [&time](ReferenceScene& scene)
    {
        const Stopwatch stopwatch;
        scene.update(time += frameTime);
        return stopwatch.elapsed();
    };
    // The pose and each floor run after an update of osgAnimation, so that all start with cold caches.
    const bool hasReference = count <= effort.largestReference;
    if (hasReference)
    {
        bones = std::make_unique<ReferenceScene>(subject, kit, ReferenceMode::Bones, count);
        hardware = std::make_unique<ReferenceScene>(subject, kit, ReferenceMode::Hardware, count);
        contestants.push_back([&] { return updating(*bones); });
    }
    contestants.push_back([&] { return floor.step(); });
    if (hasReference) contestants.push_back([&] { return updating(*hardware); });
    contestants.push_back([&] { return triangleFloor.step(); });
    if (hasReference) contestants.push_back([&] { return updating(*bones); });
    std::vector<Series> series = interleaved(effort.rounds, contestants);
    if (const std::string wrong = crowd.check(); !wrong.empty()) return Error{wrong};
    if (bones)
        for (const double moment : {0.4, 1.7, 3.1})
            if (const std::string wrong = bones->check(subject, moment); !wrong.empty()) return Error{wrong};
    if (!hasReference) return PoseSeries{series[0], series[1], series[2], {}, {}};
    return PoseSeries{series[0], series[2], series[4], series[1], series[3]};
}

void addPosePoints(const Subject& subject, std::size_t count, const PoseSeries& series, Report& report)
{
    const double characters = static_cast<double>(count);
    const double nanoseconds = 1e9 / (characters * static_cast<double>(subject.jointCount()));
    report.addPoint(posePlot, subject.name, characters, cpuOf(series.ours).median * nanoseconds);
    report.addPoint(posePlot, subject.name + ", floor", characters, cpuOf(series.floor).median * nanoseconds);
    report.addPoint(posePlot, subject.name + ", osgAnimation", characters, cpuOf(series.bones).median * nanoseconds);
}

void addPoseRows(const Subject& subject, std::size_t count, const PoseSeries& series, Report& report)
{
    const double characters = static_cast<double>(count);
    const double perJoint = 1e9 / (characters * static_cast<double>(subject.jointCount()));
    const double perEntry = 1e9 / (characters * static_cast<double>(subject.set().paletteSize()));
    const auto add = [&](Row row, const char* what, const char* unit, const char* other)
    {
        row.subject = subject.name;
        row.count = count;
        row.what = what;
        row.unit = unit;
        row.otherName = other;
        report.add(std::move(row));
    };
    Row row = compared(series.ours, series.bones, perJoint, true);
    row.bar = "≥ 7";
    row.isMet = row.ratio.median >= 7.0;
    add(row, "pose", "ns a joint", "osgAnimation's update of bones alone");
    add(compared(series.ours, series.hardware, perJoint, true), "pose", "ns a joint",
        "osgAnimation's update with the palettes of its hardware mode");
    row = compared(series.ours, series.floor, perEntry, false);
    row.bar = "≤ 2.5";
    row.isMet = row.ratio.median <= 2.5;
    add(row, "pose", "ns a palette entry", "an empty feedback pass");
    add(compared(series.ours, series.triangleFloor, perEntry, false), "pose", "ns a palette entry",
        "an empty feedback pass of triangles");
}

/// Poses that the application writes in every frame, in place of clips.
Result<void> measureStreaming(const Subject& subject, const Effort& effort, osg::GraphicsContext& context,
                              Report& report)
{
    std::cerr << subject.name << ": streaming poses" << std::endl;
    PoseCrowd crowd(subject.model.set, subject.clip, effort.barCount, context);
    PoseCrowd clips(subject.model.set, subject.clip, effort.barCount, context);
    const std::vector<Series> series =
        interleaved(effort.rounds, {[&] { return crowd.streamPoses(frameTime); }, [&] { return crowd.evaluate(); },
                                    [&]
                                    {
                                        crowd.fade(); // other samples, the same poses
                                        crowd.refill(frameTime);
                                        return crowd.evaluate();
                                    },
                                    [&]
                                    {
                                        clips.refill(frameTime);
                                        return clips.evaluate();
                                    }});
    for (PoseCrowd* one : {&crowd, &clips})
        if (const std::string wrong = one->check(); !wrong.empty()) return Error{wrong};
    const auto add = [&](Row row, const char* what, const char* unit, const char* other)
    {
        row.subject = subject.name;
        row.count = effort.barCount;
        row.what = what;
        row.unit = unit;
        row.otherName = other;
        report.add(std::move(row));
    };
    const double perCharacter = 1e6 / static_cast<double>(effort.barCount);
    Row row = compared(series[0], series[1], perCharacter, false);
    row.bar = "ours ≤ 1.5 for 51 joints";
    row.isMet = row.ours.median <= 1.5 * static_cast<double>(subject.jointCount()) / 51.0;
    add(row, "streaming all joints, from setTransforms() to the batch", "µs a character", "upload and pose");
    add(compared(series[1], series[2], perCharacter, false), "upload and pose, all poses new", "µs a character",
        "no pose new");
    add(compared(series[2], series[3], perCharacter, false), "pose of posed joints, without upload", "µs a character",
        "a clip");
    return {};
}

void addGrowth(const Subject& subject, const std::map<std::size_t, Figure>& perCharacter, Report& report)
{
    const auto few = perCharacter.find(100);
    const auto many = perCharacter.find(10000);
    if (few == perCharacter.end() || many == perCharacter.end()) return;
    Row row;
    row.subject = subject.name;
    row.count = 10000;
    row.what = "growth of the pose";
    row.unit = "µs a character";
    row.ours = many->second;
    row.otherName = "the same at N = 100";
    row.other = few->second;
    const double ratio = row.ours.median / row.other.median;
    row.ratio = {ratio, row.ours.low / row.other.high, row.ours.high / row.other.low};
    row.wallRatio = row.ratio; // both are CPU time: these series have no common rounds with wall times
    row.bar = "≤ 1.15";
    row.isMet = ratio <= 1.15;
    report.add(row);
}

} // namespace

Result<void> measurePose(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report)
{
    report.describePlot(posePlot, "Pose: CPU time a joint, from advance() to the finished palette", "characters",
                        "ns a joint");
    ReferenceKit kit(subject);
    std::map<std::size_t, Figure> perCharacter;
    for (const std::size_t count : effort.poseCounts)
    {
        std::cerr << subject.name << ": pose of " << count << std::endl;
        context.makeCurrent();
        const Result<PoseSeries> series = poseSeries(subject, kit, count, effort, context);
        if (!series) return series.error();
        addPosePoints(subject, count, series.value(), report);
        const double microseconds = 1e6 / static_cast<double>(count);
        const Figure ours = cpuOf(series.value().ours);
        perCharacter[count] = {ours.median * microseconds, ours.low * microseconds, ours.high * microseconds};
        if (count == effort.barCount) addPoseRows(subject, count, series.value(), report);
    }
    addGrowth(subject, perCharacter, report);
    return measureStreaming(subject, effort, context, report);
}

Result<void> measureDepth(const Effort& effort, osg::GraphicsContext& context, Report& report)
{
    constexpr std::size_t joints = 64;
    constexpr std::size_t shallow = 8;
    report.describePlot(depthPlot, "Pose over the depth of the skeleton (64 joints in chains, 1,000 characters)",
                        "joints from root to leaf", "ns a joint");
    std::vector<std::unique_ptr<PoseCrowd>> crowds;
    std::vector<std::function<Spent()>> contestants;
    const std::vector<std::size_t> depths{1, 2, 4, shallow, 16, 32, joints};
    for (const std::size_t depth : depths)
    {
        crowds.push_back(std::make_unique<PoseCrowd>(makeChains(joints / depth, depth), 0, effort.barCount, context));
        PoseCrowd* crowd = crowds.back().get();
        contestants.push_back([crowd] { return crowd->step(frameTime); });
        contestants.push_back([crowd] { return crowd->step(frameTime, PosePipeline::Form::Separate); });
    }
    std::cerr << "chains: pose over depth" << std::endl;
    const std::vector<Series> series = interleaved(effort.rounds, contestants);
    const double nanoseconds = 1e9 / static_cast<double>(joints * effort.barCount);
    std::size_t shallowAt = 0;
    for (std::size_t i = 0; i < depths.size(); ++i)
    {
        if (const std::string wrong = crowds[i]->check(); !wrong.empty()) return Error{wrong};
        if (depths[i] == shallow) shallowAt = 2 * i;
        const auto depth = static_cast<double>(depths[i]);
        report.addPoint(depthPlot, "fused, a draw a level", depth, cpuOf(series[2 * i]).median * nanoseconds);
        report.addPoint(depthPlot, "separate, the walk", depth, cpuOf(series[2 * i + 1]).median * nanoseconds);
    }
    Row row = compared(series[2 * (depths.size() - 1)], series[shallowAt], nanoseconds, false);
    row.subject = "chains of 64";
    row.count = effort.barCount;
    row.what = "pose over depth";
    row.unit = "ns a joint";
    row.otherName = "chains of 8";
    row.bar = "≤ 1.3";
    row.isMet = row.ratio.median <= 1.3;
    report.add(row);
    return {};
}

} // namespace osgGpuAnimation::benchmark
