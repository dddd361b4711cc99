// SPDX-License-Identifier: MIT
#include "tool/CpuPoseEvaluator.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

namespace osgGpuAnimation::tool
{

Result<EvaluatedPose> CpuPoseEvaluator::evaluate(const PoseInstruction& instruction,
                                                 const std::vector<FixedEntry>& fixedEntries)
{
    EvaluatedPose pose;
    Pose::evaluate(*_model.set, instruction, AffineMatrix(), pose.palette);
    for (const FixedEntry& fixed : fixedEntries)
        pose.palette[fixed.entry] = fixed.value;
    for (const gltf::ImportedPrimitive& primitive : _model.primitives)
    {
        pose.positions.emplace_back();
        const auto* geometry = dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get());
        if (geometry) geometry->computePositions(pose.palette, pose.positions.back());
    }
    return pose;
}

} // namespace osgGpuAnimation::tool
