// SPDX-License-Identifier: MIT
#include "tool/PoseEvaluator.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

namespace osgGpuAnimation::tool
{

namespace
{

class CpuPoseEvaluator : public PoseEvaluator
{
public:
    explicit CpuPoseEvaluator(const gltf::ImportedModel& model) : _model(model) {}

    std::string name() const override { return "osggpuanim, CPU"; }

    Result<EvaluatedPose> evaluate(const PoseInstruction& instruction,
                                   const std::vector<FixedEntry>& fixedEntries) override
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

private:
    const gltf::ImportedModel& _model;
};

} // namespace

std::unique_ptr<PoseEvaluator> cpuPoseEvaluator(const gltf::ImportedModel& model)
{
    return std::make_unique<CpuPoseEvaluator>(model);
}

} // namespace osgGpuAnimation::tool
