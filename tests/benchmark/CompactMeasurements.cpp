// SPDX-License-Identifier: MIT
#include "Measurements.h"
#include "PoseCrowd.h"

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>

#include <iostream>

namespace osgGpuAnimation::benchmark
{

Result<void> measureCompact(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report)
{
    constexpr double frameTime = 1.0 / 60.0;
    std::cerr << subject.name << ": pose of compact clips" << std::endl;
    const Result<Subject> compact = loadSubject(subject.name, subject.fileName, true, 1e-4);
    if (!compact) return compact.error();
    PoseCrowd exactCrowd(subject.model.set, subject.clip, effort.barCount, context);
    PoseCrowd compactCrowd(compact.value().model.set, subject.clip, effort.barCount, context);
    const std::vector<Series> series = interleaved(
        4 * effort.rounds, {[&] { return compactCrowd.step(frameTime); }, [&] { return exactCrowd.step(frameTime); }});
    for (PoseCrowd* crowd : {&compactCrowd, &exactCrowd})
        if (const std::string wrong = crowd->check(); !wrong.empty()) return Error{wrong};
    const double perJoint = 1e9 / static_cast<double>(effort.barCount * subject.jointCount());
    Row row = compared(series[0], series[1], perJoint, false);
    row.subject = subject.name;
    row.count = effort.barCount;
    row.what = "pose of clips within 1e-4 of the size, " +
               std::to_string(PackedKeyframes(*compact.value().model.set).byteSize()) + " bytes";
    row.unit = "ns a joint";
    row.otherName = "exact clips, " + std::to_string(PackedKeyframes(*subject.model.set).byteSize()) + " bytes";
    report.add(row);
    return {};
}

} // namespace osgGpuAnimation::benchmark
