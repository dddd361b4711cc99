// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace osgGpuAnimation
{

/// Two neighbouring keyframes and how to mix them: the 16 bytes that go to the GPU for one clip of one character.
struct BlendSample
{
    std::uint32_t keyframe = 0; ///< offset of the first of the two in the set's keyframe buffer, in JointTransforms
    float alpha = 0.0f;         ///< [0, 1): 0 is the first keyframe
    float weight = 1.0f;        ///< share of this sample in the character's pose
    std::uint32_t control = 0;  ///< bits of layout.glsl: POSE_SAMPLE_SPLINE …
};

static_assert(sizeof(BlendSample) == 16, "a blend sample is 16 bytes on the GPU");

/// What a controller says to the GPU this frame: the samples whose mix is the character's pose.
/// Default: the rest pose.
struct PoseInstruction
{
    static constexpr std::size_t maxSamples = 8;

    std::array<BlendSample, maxSamples> samples;
    std::size_t sampleCount = 1; ///< [1, maxSamples]
};

} // namespace osgGpuAnimation
