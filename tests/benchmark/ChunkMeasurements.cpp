// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "PoseCrowd.h"

#include <iostream>

namespace osgGpuAnimation::benchmark
{

Result<void> measureChunks(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report)
{
    constexpr std::size_t sizes[] = {64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384};
    constexpr double frameTime = 1.0 / 60.0;
    for (const std::size_t count : {effort.barCount, effort.crowdCount})
    {
        std::cerr << subject.name << ": pose of " << count << " in chunks" << std::endl;
        std::vector<std::unique_ptr<PoseCrowd>> crowds;
        std::vector<std::function<Spent()>> contestants;
        for (const std::size_t size : sizes)
        {
            crowds.push_back(std::make_unique<PoseCrowd>(subject.model.set, subject.clip, count, context));
            crowds.back()->setChunkSize(size);
            contestants.push_back([crowd = crowds.back().get()] { return crowd->step(frameTime); });
        }
        const std::vector<Series> series = interleaved(effort.rounds, contestants);
        for (std::size_t i = 0; i < crowds.size() && (i == 0 || sizes[i - 1] < count); ++i)
        {
            if (const std::string wrong = crowds[i]->check(); !wrong.empty()) return Error{wrong};
            const double perJoint = 1e9 / static_cast<double>(count * subject.jointCount());
            Row row = compared(series[i], series.back(), perJoint, false);
            row.subject = subject.name;
            row.count = count;
            row.what = "pose in chunks of " + std::to_string(sizes[i]);
            row.unit = "ns a joint";
            row.otherName = "of 16384";
            report.add(row);
        }
    }
    return {};
}

} // namespace osgGpuAnimation::benchmark
