// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>

#include <vector>

namespace osgGpuAnimation
{

/// The CPU twin of the GPU's stages, for tools, picking and tests. It computes jointToModel parents first and
/// entry = jointToModel · inverseBind: the plain way, against which the shaders' shorter way is checked.
namespace Pose
{

/// Mix: outTracks gets set.trackCount() transforms.
void mix(const AnimationSet& set, const PoseInstruction& instruction, std::vector<JointTransform>& outTracks);

/// Local and world: outJointToModel gets set.skeleton().jointCount() matrices, roots multiplied by rootToModel.
void jointToModel(const AnimationSet& set, const std::vector<JointTransform>& tracks, const AffineMatrix& rootToModel,
                  std::vector<AffineMatrix>& outJointToModel);

/// One joint's matrix, computed from its own chain of parents alone; does not allocate. joint: below the skeleton's
/// jointCount().
AffineMatrix jointToModel(const AnimationSet& set, const PoseInstruction& instruction, std::size_t joint);

/// outPalette gets set.paletteSize() entries: matrices, and weight blocks as they are.
void palette(const AnimationSet& set, const std::vector<JointTransform>& tracks,
             const std::vector<AffineMatrix>& jointToModel, std::vector<AffineMatrix>& outPalette);

/// All of it.
void evaluate(const AnimationSet& set, const PoseInstruction& instruction, const AffineMatrix& rootToModel,
              std::vector<AffineMatrix>& outPalette);

} // namespace Pose
} // namespace osgGpuAnimation
