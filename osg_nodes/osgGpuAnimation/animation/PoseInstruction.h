// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace osgGpuAnimation
{

/// Two neighbouring keyframes and how to mix them: the 16 bytes that go to the GPU for one clip of one character.
/// Additive layers take two: their reference, then themselves.
struct BlendSample
{
    std::uint32_t keyframe = 0; ///< the first of the two, see AnimationSet::firstKeyframe(); 0: the rest pose
    float alpha = 0.0f;         ///< [0, 1): 0 is the first keyframe
    float weight = 1.0f;        ///< [0, 1]; negative and not a number count as 0
    std::uint32_t control = 0;  ///< bits of layout.glsl: POSE_SAMPLE_SPLINE …, and the mask's number << 16
};

static_assert(sizeof(BlendSample) == 16, "a blend sample is 16 bytes on the GPU");

/// What a controller says to the GPU this frame: the samples whose mix is the character's pose.
/// Default: the rest pose.
///
/// How samples make a pose, joint by joint (shaders/mix.glsl and its twin Pose):
/// - A sample's weight at a joint is its own times its mask's there.
/// - Samples come in **standings**, from the bottom up; POSE_SAMPLE_ABOVE begins the next. Those of one standing share
///   the joint by their weights: a sum above 1 is scaled to 1, what a sum below 1 leaves goes to the standings below,
///   and in the end to the rest pose.
/// - Translations, scales and morph weights are summed. Rotations are summed as unit quaternions on one hemisphere and
///   made unit: within a standing the hemisphere of its first sample that counts at the joint, and the standing's sum
///   as a whole on that of what lies below. Controllers put the heaviest sample first, so that the result does not
///   depend on the order of layers, no two samples can cancel out, and what fades in never turns round what is shown.
///   (The rest pose's hemisphere would be simpler, but two nearly equal poses half a turn away from rest would cancel.)
/// - Additive samples come last and add up, in any order alike: with d = R_reference⁻¹ · R, rotations are multiplied
///   by exp(Σ weight · log d), the sum being held within a full turn; translations get Σ weight · (T − T_reference);
///   scales are multiplied by Π (1 + weight · (S / S_reference − 1)), axes with a reference of 0 staying as they are.
struct PoseInstruction
{
    static constexpr std::size_t maxSamples = 16;

    std::size_t sampleCount = 1; ///< [1, maxSamples]
    std::array<BlendSample, maxSamples> samples;
};

} // namespace osgGpuAnimation
