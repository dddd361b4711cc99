// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Constraint.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// Two neighbouring keyframes and how to mix them: the 16 bytes that the GPU gets for one clip of one character.
/// Additive layers take two samples: their reference, then the sample itself.
struct BlendSample
{
    /// the first keyframe, see AnimationSet::firstKeyframe(); 0: the rest pose; POSE_SAMPLE_POSED: an index of
    /// PoseInstruction::poses
    std::uint32_t keyframe = 0;
    float alpha = 0.0f;        ///< share of the second keyframe, in [0, 1)
    float weight = 1.0f;       ///< in [0, 1]; negative values and NaN count as 0
    std::uint32_t control = 0; ///< bits of layout.glsl: POSE_SAMPLE_SPLINE …, and the number of the mask << 16
};

static_assert(sizeof(BlendSample) == 16, "a blend sample is 16 bytes on the GPU");

class JointPose;

/// The blend samples of one character in one frame: the GPU mixes them to the character's pose. Default: the rest pose.
///
/// The mix, joint by joint (shaders/mix.glsl and its CPU twin Pose):
/// - The weight of a sample at a joint is its own weight times the weight of its mask.
/// - Samples are grouped into **blend priorities**, from the bottom up; POSE_SAMPLE_ABOVE begins the next blend
///   priority. Samples of one blend priority share the joint by their weights: a sum above 1 is scaled to 1. If the
///   weights sum to less than 1, the blend priorities below fill the remainder; the rest pose comes last.
/// - Translations, scales and morph weights are summed. Rotations are summed as unit quaternions on one hemisphere and
///   normalized: within a blend priority the hemisphere of its first sample with a weight at the joint; the sum of a
///   blend priority takes the hemisphere of the blend priorities below. Controllers put the heaviest sample first, so
///   the order of layers does not matter, no two samples cancel out, and a sample that fades in never reverses the
///   visible one. (The hemisphere of the rest pose would be simpler, but two nearly equal poses half a turn away from
///   rest would cancel out.)
/// - Additive samples come last; their order does not matter. With d = R_reference⁻¹ · R, rotations are multiplied by
///   exp(Σ weight · log d), with the sum limited to a full turn; translations get Σ weight · (T − T_reference); scales
///   are multiplied by Π (1 + weight · (S / S_reference − 1)), except on axes with a reference of 0.
/// - A posed sample (POSE_SAMPLE_POSED) has no weight at the parts of joints and the morph weights that are not set in
///   its pose.
struct PoseInstruction
{
    static constexpr std::size_t maxSamples = 16; ///< the maximum number of samples of one pose

    std::size_t sampleCount = 1;                 ///< [1, maxSamples]
    std::array<BlendSample, maxSamples> samples; ///< only the first sampleCount are used
    /// The poses of the posed samples. They change with their layers; whoever keeps a pose for later takes its
    /// JointPose::sharedKeyframe(). A null pose, or one with another number of tracks than the set, shows nothing.
    std::vector<std::shared_ptr<const JointPose>> poses{};
    /// One per constraint of the set, solved in this order after the mix; empty: none has an effect.
    std::vector<ConstraintTarget> targets{};
};

} // namespace osgGpuAnimation
