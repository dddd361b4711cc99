// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

class PosedKeyframe;

/// The CPU twin of the GPU stages, for tools, picking and tests. It computes jointToModel parents first and
/// entry = jointToModel · inverseBind: the direct form, which tests compare with the shaders' shorter one. Palettes are
/// finite whatever the values: products are limited to ±1e18, here and in the shaders.
namespace Pose
{

/// The mix stage and the constraints. outTracks: set.trackCount() transforms.
void mix(const AnimationSet& set, const PoseInstruction& instruction, std::vector<JointTransform>& outTracks);

/// The local and world stages. tracks: as from mix(). outJointToModel: one matrix per joint; roots are multiplied by
/// rootToModel.
void jointToModel(const AnimationSet& set, const std::vector<JointTransform>& tracks, const AffineMatrix& rootToModel,
                  std::vector<AffineMatrix>& outJointToModel);

/// The matrix of one joint, computed from its chain of parents only. Does not allocate.
/// joint: below set.skeleton().jointCount().
AffineMatrix jointToModel(const AnimationSet& set, const PoseInstruction& instruction, std::size_t joint);

/// The mix stage of the set's properties alone (see MorphWeights). outNumbers: the numbers of all properties, in the
/// order of set.morphs().
void properties(const AnimationSet& set, const PoseInstruction& instruction, std::vector<float>& outNumbers);

/// outPalette: set.paletteSize() entries, row-major 3x4 matrices; weight blocks are copied.
void palette(const AnimationSet& set, const std::vector<JointTransform>& tracks,
             const std::vector<AffineMatrix>& jointToModel, std::vector<AffineMatrix>& outPalette);

/// All stages. outPalette: set.paletteSize() entries.
void evaluate(const AnimationSet& set, const PoseInstruction& instruction, const AffineMatrix& rootToModel,
              std::vector<AffineMatrix>& outPalette);

/// A pose as a PoseBatch keeps it.
struct BatchedPose
{
    const BlendSample* samples = nullptr; ///< see PoseInstruction
    std::size_t sampleCount = 0;          ///< at most PoseInstruction::maxSamples
    /// The posed keyframes; BlendSample::keyframe of a posed sample is an index of these.
    const std::shared_ptr<const PosedKeyframe>* posed = nullptr;
    /// One per constraint of the set, already moved by rootToModel; null: none has an effect.
    const ConstraintTarget* targets = nullptr;
};
/// All stages. outPalette: set.paletteSize() entries.
void evaluate(const AnimationSet& set, const BatchedPose& pose, const AffineMatrix& rootToModel,
              std::vector<AffineMatrix>& outPalette);

} // namespace Pose
} // namespace osgGpuAnimation
