// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "PoseCrowd.h"

#include <iostream>

namespace osgGpuAnimation::benchmark
{

Result<void> measureSamples(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report)
{
    constexpr std::size_t samples = 4;
    constexpr double frameTime = 1.0 / 60.0;
    std::cerr << subject.name << ": pose of " << samples << " samples a character" << std::endl;
    PoseCrowd one(subject.model.set, subject.clip, effort.barCount, context);
    PoseCrowd four(subject.model.set, subject.clip, effort.barCount, context);
    for (std::size_t i = 1; i < samples; ++i)
        four.crossfade(subject.clip);
    // Some characters crossfade, as in a typical crowd.
    PoseCrowd someDealtOut(subject.model.set, subject.clip, effort.barCount, context);
    PoseCrowd someInOne(subject.model.set, subject.clip, effort.barCount, context);
    for (PoseCrowd* some : {&someDealtOut, &someInOne})
        for (std::size_t i = 1; i < samples; ++i)
            some->crossfade(subject.clip, 20);
    someInOne.setDealtOut(false);
    const auto step = [](PoseCrowd& crowd) { return [&crowd] { return crowd.step(frameTime); }; };
    const std::vector<Series> series =
        interleaved(effort.rounds, {step(four), step(one), step(someDealtOut), step(someInOne)});
    for (PoseCrowd* crowd : {&one, &four, &someDealtOut, &someInOne})
        if (const std::string wrong = crowd->check(); !wrong.empty()) return Error{wrong};
    const double perJoint = 1e9 / static_cast<double>(effort.barCount * subject.jointCount());
    Row row = compared(series[0], series[1], perJoint, false);
    row.subject = subject.name;
    row.count = effort.barCount;
    row.what = "pose of 4 blend samples";
    row.unit = "ns a joint";
    row.otherName = "1 blend sample";
    row.bar = "≤ 2.5";
    row.isMet = row.ratio.median <= 2.5;
    report.add(row);
    for (const std::size_t some : {2, 3})
    {
        row = compared(series[some], series[1], perJoint, false);
        row.subject = subject.name;
        row.count = effort.barCount;
        row.what = some == 2 ? "pose where 5 % have 4 blend samples" : "the same in one batch";
        row.unit = "ns a joint";
        row.otherName = "1 blend sample";
        report.add(row);
    }
    return {};
}

} // namespace osgGpuAnimation::benchmark
