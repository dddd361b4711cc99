// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Primitives (glTF 2.0, section 3.7.2): attributes and morph targets have the types that they may have and one value a
/// vertex, indices are integers below the number of vertices, joints come with weights, node weights fit the targets.
/// Warns of incomplete triangles and of textures whose coordinates a primitive lacks. Many primitives can share one
/// accessor, so all their reads together are limited to budget.limit() bytes, which bounds the time.
///
/// Skinning (section 3.7.3.3): a vertex names joints of every skin that its mesh is used with. This is the one place
/// that mends influences, with a warning and in data of our own: weights that are negative or do not sum to 1, joint
/// numbers beyond the skin that have no weight. A node loses its skin, with a warning, if its mesh has no joints.
/// Returns the first fault, for which the document must be refused.
std::optional<Error> validateMeshes(tinygltf::Model& model, MemoryBudget& budget, Report& report);

} // namespace osgGpuAnimation::gltf
