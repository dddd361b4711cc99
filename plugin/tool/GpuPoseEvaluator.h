// SPDX-License-Identifier: MIT
#pragma once

#include "tool/PoseEvaluator.h"

#include <osgGpuAnimation/gpu/EglGraphicsContext.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Program>
#include <osg/StateSet>

#include <memory>
#include <vector>

namespace osgGpuAnimation::tool
{

/// Computes poses with the GPU's pipeline, in a context of its own: reads matrices back from the palette buffer and
/// captures positions, by transform feedback, from the function of skin.glsl that draws characters.
class GpuPoseEvaluator : public PoseEvaluator
{
public:
    /// The model must outlive the evaluator; it has a character.
    /// Error: no graphics context can be created, or it lacks a feature that the pipeline needs.
    static Result<std::unique_ptr<PoseEvaluator>> create(const gltf::ImportedModel& model);
    ~GpuPoseEvaluator() override;

    std::string name() const override;
    Result<EvaluatedPose> evaluate(const PoseInstruction& instruction,
                                   const std::vector<FixedEntry>& fixedEntries) override;

private:
    GpuPoseEvaluator(const gltf::ImportedModel& model, osg::ref_ptr<EglGraphicsContext> context,
                     PosePipeline& pipeline);

    void writeEntries(const std::vector<FixedEntry>& fixedEntries);
    std::vector<glm::dvec3> capture(SkinnedGeometry& points);

    const gltf::ImportedModel& _model;
    osg::ref_ptr<EglGraphicsContext> _context;
    PosePipeline& _pipeline;
    osg::ref_ptr<osg::StateSet> _stateSet; ///< the capturing program and the character's palette
    /// One a primitive: its vertices in order, as points. Null if it is not drawn from the palette.
    std::vector<osg::ref_ptr<SkinnedGeometry>> _points;
};

} // namespace osgGpuAnimation::tool
