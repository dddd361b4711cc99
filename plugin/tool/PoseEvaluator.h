// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <glm/vec3.hpp>

#include <functional>
#include <string>
#include <vector>

namespace osgGpuAnimation::tool
{

/// A computed pose of a model's character.
struct EvaluatedPose
{
    std::vector<AffineMatrix> palette; ///< AnimationSet::paletteSize() entries
    /// One list per primitive of the model, one position per vertex of its geometry, in the character's own space.
    /// Empty for primitives that are not drawn from the palette.
    std::vector<std::vector<glm::dvec3>> positions;
};

/// Computes the poses of instructions for the model's set.
struct PoseEvaluator
{
    std::string name;
    std::function<Result<EvaluatedPose>(const PoseInstruction&)> evaluate;
};

// The model must outlive the evaluator; it has a character.

/// With the CPU twins of the shaders: Pose for the palette, SkinnedGeometry::computePositions for the vertices.
PoseEvaluator cpuPoseEvaluator(const gltf::ImportedModel& model);

/// With the GPU's pipeline, in a context of its own: reads matrices back from the palette buffer and captures
/// positions, by transform feedback, from the function of skin.glsl that draws characters. Error: no graphics context
/// can be created, or it lacks a feature that the pipeline needs.
Result<PoseEvaluator> gpuPoseEvaluator(const gltf::ImportedModel& model);

} // namespace osgGpuAnimation::tool
