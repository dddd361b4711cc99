// SPDX-License-Identifier: MIT
#pragma once

#include "tool/PoseEvaluator.h"

namespace osgGpuAnimation::tool
{

/// Computes poses with the CPU twins of the shaders: Pose for the palette, SkinnedGeometry::computePositions for the
/// vertices.
class CpuPoseEvaluator : public PoseEvaluator
{
public:
    /// The model must outlive the evaluator; it has a character.
    explicit CpuPoseEvaluator(const gltf::ImportedModel& model) : _model(model) {}

    std::string name() const override { return "osggpuanim, CPU"; }
    Result<EvaluatedPose> evaluate(const PoseInstruction& instruction,
                                   const std::vector<FixedEntry>& fixedEntries) override;

private:
    const gltf::ImportedModel& _model;
};

} // namespace osgGpuAnimation::tool
