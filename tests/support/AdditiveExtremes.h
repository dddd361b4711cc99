// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <layout.glsl>

#include <cmath>
#include <cstdint>

namespace osgGpuAnimation
{

/// One joint whose scale at rest is negative, 0 and positive, and a clip of one second that doubles the first axis,
/// raises the second, halves the third, and turns by 170 degrees about z.
inline std::shared_ptr<const AnimationSet> makeAdditiveExtremes()
{
    Joint joint;
    joint.rest.scale = glm::vec4(-1, 0, 2, 0);
    const Skeleton skeleton = Skeleton::create({joint}).value();
    ClipBuilder builder(skeleton, {});
    const double half = 85.0 / 180.0 * std::acos(-1.0);
    const auto linear = Channel::Interpolation::Linear;
    (void)builder.add({Channel::Path::Scale, linear, 0, {0, 1}, {-1, 0, 2, -2, 3, 1}});
    (void)builder.add({Channel::Path::Rotation, linear, 0, {0, 1}, {0, 0, 0, 1, 0, 0, std::sin(half), std::cos(half)}});
    return AnimationSet::create({skeleton, {}, {0}, {}, {builder.build("grow")}}).value();
}

/// The rest pose, and the end of the clip added to it so many times, at most 7, measured from the clip's beginning.
inline PoseInstruction addedTimes(const AnimationSet& set, std::size_t times)
{
    const auto first = static_cast<std::uint32_t>(set.firstKeyframe(0));
    PoseInstruction instruction;
    for (std::size_t i = 0; i < times; ++i)
    {
        instruction.samples[instruction.sampleCount++] = {first, 0.0f, 1.0f, POSE_SAMPLE_REFERENCE};
        instruction.samples[instruction.sampleCount++] = {first + 1, 0.0f, 1.0f, POSE_SAMPLE_ADDITIVE};
    }
    return instruction;
}

} // namespace osgGpuAnimation
