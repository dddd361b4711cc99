// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "PoseCrowd.h"

#include <iostream>

namespace osgGpuAnimation::benchmark
{

Result<bool> measureSamples(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report)
{
    constexpr std::size_t samples = 4;
    constexpr double frameTime = 1.0 / 60.0;
    std::cerr << subject.name << ": pose of " << samples << " samples a character" << std::endl;
    PoseCrowd one(subject.model.set, subject.clip, effort.barCount, context);
    PoseCrowd four(subject.model.set, subject.clip, effort.barCount, context);
    for (std::size_t i = 1; i < samples; ++i)
        four.crossfade(subject.clip);
    const std::vector<Series> series =
        interleaved(effort.rounds, {[&] { return four.step(frameTime); }, [&] { return one.step(frameTime); }});
    for (PoseCrowd* crowd : {&one, &four})
        if (const std::string wrong = crowd->check(); !wrong.empty()) return Error{wrong};
    Row row = compared(series[0], series[1], 1e9 / static_cast<double>(effort.barCount * subject.jointCount()), false);
    row.subject = subject.name;
    row.count = effort.barCount;
    row.what = "pose of 4 blend samples";
    row.unit = "ns a joint";
    row.otherName = "1 blend sample";
    row.bar = "≤ 2.5";
    row.isMet = row.ratio.median <= 2.5;
    report.add(row);
    return true;
}

} // namespace osgGpuAnimation::benchmark
