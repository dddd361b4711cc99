// SPDX-License-Identifier: MIT
#include "ChainSet.h"
#include "Measurements.h"
#include "PoseCrowd.h"
#include "Scenes.h"

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <map>

namespace osgGpuAnimation::benchmark
{

namespace
{

/// A crowd of the subject as it is.
PoseCrowd crowdOf(const Subject& subject, Run& run)
{
    return PoseCrowd(subject.model.set, subject.clip, run.barCount, run.context);
}

double perJoint(const Subject& subject, std::size_t count)
{
    return 1e9 / static_cast<double>(count * subject.jointCount());
}

/// The times for one number of a subject's characters.
struct PoseSeries
{
    Series ours, bones, floor; ///< bones: empty if there are too many characters for osgAnimation
};

PoseSeries poseSeries(const Subject& subject, const ReferenceKit& kit, std::size_t count, Run& run)
{
    PoseCrowd crowd(subject.model.set, subject.clip, count, run.context);
    FeedbackFloor floor(subject.set().paletteSize() * count, run.context);
    const auto step = [&] { return crowd.step(); };
    const auto stepOfFloor = [&] { return floor.step(); };
    if (count > Run::maxReferenceCount)
    {
        const std::vector<Series> series = interleaved(run.rounds, {step, stepOfFloor});
        crowd.check();
        return {series[0], {}, series[1]};
    }
    ReferenceScene bones(subject, kit, ReferenceMode::Bones, count);
    double time = 0.0;
    const auto update = [&]
    {
        const Stopwatch stopwatch;
        bones.update(time += frameTime);
        return stopwatch.elapsed();
    };
    // The pose and the floor run after an update of osgAnimation, so that both start with cold caches.
    const std::vector<Series> series = interleaved(run.rounds, {step, update, stepOfFloor, update});
    crowd.check();
    for (const double moment : {0.4, 1.7, 3.1})
        bones.check(subject, moment);
    return {series[0], series[1], series[2]};
}

/// Poses that the application writes in every frame, as motion capture does, in place of clips.
void measureStreaming(const Subject& subject, Run& run)
{
    PoseCrowd posed = crowdOf(subject, run), clips = crowdOf(subject, run);
    std::vector<std::vector<JointTransform>> captured(16);
    for (std::vector<JointTransform>& frame : captured)
    {
        Pose::mix(subject.set(), posed.controllers[0].advance(0.05), frame);
        frame.resize(subject.jointCount());
    }
    for (AnimationController& controller : posed.controllers)
        controller.layer(0).showPose();
    std::size_t frame = 0;
    const auto stream = [&]
    {
        const Stopwatch stopwatch;
        for (AnimationController& controller : posed.controllers)
            taken(controller.layer(0).pose().setTransforms(captured[++frame % captured.size()]));
        posed.refill();
        return stopwatch.elapsed();
    };
    const auto fade = [&] // other samples, the same poses
    {
        for (AnimationController& controller : posed.controllers)
            controller.layer(0).setWeight(controller.layer(0).weight() == 1.0f ? 0.99f : 1.0f);
        posed.refill();
        return posed.evaluate();
    };
    const auto play = [&]
    {
        clips.refill();
        return clips.evaluate();
    };
    const std::vector<Series> series = interleaved(run.rounds, {stream, [&] { return posed.evaluate(); }, fade, play});
    posed.check();
    clips.check();
    const auto row = [&](const char* what, const Series& ours)
    { return Row(subject.name, run.barCount, what, "µs a character", ours, 1e6 / static_cast<double>(run.barCount)); };
    run.report.add(row("streaming all joints, from setTransforms() to the batch", series[0])
                       .atMost(1.5 * static_cast<double>(subject.jointCount()) / 51.0));
    run.report.add(row("upload and pose, all poses new", series[1]).against("no pose new", series[2]));
    run.report.add(row("pose of posed joints, without upload", series[2]).against("a clip", series[3]));
}

void addGrowth(const Subject& subject, const Figure& few, const Figure& many, Report& report)
{
    Row row(subject.name, 10000, "growth of the pose", "µs a character", many);
    row.otherName = "the same at N = 100";
    row.other = few;
    row.ratio = {many.median / few.median, many.low / few.high, many.high / few.low};
    report.add(row.atMost(1.15));
}

} // namespace

void measurePose(const Subject& subject, Run& run)
{
    const ReferenceKit kit(subject);
    std::map<std::size_t, Figure> perCharacter;
    for (const std::size_t count : run.poseCounts)
    {
        const PoseSeries series = poseSeries(subject, kit, count, run);
        perCharacter[count] = figureOf(series.ours, 1e6 / static_cast<double>(count));
        Row floor(subject.name, count, "pose", "ns a joint", series.ours, perJoint(subject, count)), bones = floor;
        floor.against("an empty feedback pass", series.floor);
        bones.fasterThan("osgAnimation's update of bones alone", series.bones);
        if (count == run.barCount)
        {
            floor.atMost(2.5);
            bones.atLeast(7.0);
        }
        run.report.add(floor);
        if (!series.bones.empty()) run.report.add(bones);
    }
    addGrowth(subject, perCharacter.at(100), perCharacter.at(10000), run.report);
    measureStreaming(subject, run);
}

void measureSamples(const Subject& subject, Run& run)
{
    PoseCrowd one = crowdOf(subject, run), four = crowdOf(subject, run), some = crowdOf(subject, run);
    four.addSamples();
    some.addSamples(20); // some characters crossfade, as in a typical crowd
    const std::vector<Series> series =
        interleaved(run.rounds, {[&] { return one.step(); }, [&] { return four.step(); }, [&] { return some.step(); }});
    for (const PoseCrowd* crowd : {&one, &four, &some})
        crowd->check();
    const auto row = [&](const char* what, const Series& ours)
    {
        return Row(subject.name, run.barCount, what, "ns a joint", ours, perJoint(subject, run.barCount))
            .against("1 blend sample", series[0]);
    };
    run.report.add(row("pose of 4 blend samples", series[1]).atMost(2.5));
    run.report.add(row("pose where 5 % have 4 blend samples", series[2]));
}

void measureChunks(const Subject& subject, Run& run)
{
    constexpr std::size_t sizes[] = {64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384};
    for (const std::size_t count : {run.barCount, run.crowdCount})
    {
        std::vector<std::unique_ptr<PoseCrowd>> crowds;
        std::vector<std::function<Spent()>> contestants;
        for (const std::size_t size : sizes)
        {
            crowds.push_back(std::make_unique<PoseCrowd>(subject.model.set, subject.clip, count, run.context));
            crowds.back()->options.chunkSize = size;
            contestants.push_back([crowd = crowds.back().get()] { return crowd->step(); });
        }
        const std::vector<Series> series = interleaved(run.rounds, contestants);
        for (std::size_t i = 0; i < crowds.size() && (i == 0 || sizes[i - 1] < count); ++i)
        {
            crowds[i]->check();
            run.report.add(Row(subject.name, count, "pose in chunks of " + std::to_string(sizes[i]), "ns a joint",
                               series[i], perJoint(subject, count))
                               .against("of 16384", series.back()));
        }
    }
}

void measureCompact(const Subject& subject, Run& run)
{
    const Subject compact = taken(loadSubject(subject.fileName, true, 1e-4));
    PoseCrowd exactCrowd = crowdOf(subject, run), compactCrowd = crowdOf(compact, run);
    const std::vector<Series> series =
        interleaved(4 * run.rounds, {[&] { return compactCrowd.step(); }, [&] { return exactCrowd.step(); }});
    compactCrowd.check();
    exactCrowd.check();
    const auto bytes = [](const Subject& of)
    { return ", " + std::to_string(PackedKeyframes(of.set()).byteSize()) + " bytes"; };
    run.report.add(Row(subject.name, run.barCount, "pose of clips within 1e-4 of the size" + bytes(compact),
                       "ns a joint", series[0], perJoint(subject, run.barCount))
                       .against("exact clips" + bytes(subject), series[1]));
}

void measureDepth(Run& run)
{
    constexpr std::size_t joints = 64;
    std::vector<std::unique_ptr<PoseCrowd>> crowds;
    std::vector<std::function<Spent()>> contestants;
    const std::vector<std::size_t> depths{1, 2, 4, 8, 16, 32, joints};
    for (const std::size_t depth : depths)
    {
        crowds.push_back(std::make_unique<PoseCrowd>(makeChains(joints / depth, depth), 0, run.barCount, run.context));
        for (const PosePipeline::Form form : {PosePipeline::Form::Fused, PosePipeline::Form::Separate})
            contestants.push_back(
                [crowd = crowds.back().get(), form]
                {
                    crowd->options.form = form;
                    return crowd->step();
                });
    }
    const std::vector<Series> series = interleaved(run.rounds, contestants);
    const double nanoseconds = 1e9 / static_cast<double>(joints * run.barCount);
    std::map<std::size_t, Series> fused;
    const auto row = [&](std::size_t depth)
    {
        return Row("chains of " + std::to_string(depth), run.barCount, "pose over depth", "ns a joint", fused[depth],
                   nanoseconds);
    };
    for (std::size_t i = 0; i < depths.size(); ++i)
    {
        crowds[i]->check();
        fused[depths[i]] = series[2 * i];
        run.report.add(row(depths[i]).against("three passes and a walk to the root", series[2 * i + 1]));
    }
    run.report.add(row(joints).against("chains of 8", fused[8]).atMost(1.3));
}

} // namespace osgGpuAnimation::benchmark
