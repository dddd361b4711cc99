// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <tiny_gltf.h>

#include <cstddef>
#include <optional>

namespace osgGpuAnimation::gltf
{

// The checks of a model's data. Each returns the first fault, for which the document must be refused.

/// Every buffer view lies within its buffer, every accessor within its view, aligned, sparse parts included; sparse
/// indices increase and lie within the accessor; no float is NaN or infinite (glTF 2.0, section 3.6). Accessors without
/// data hold zeros, whose number the data of the document limits. Primitives lose normals, tangents, colours and
/// texture coordinates that are not finite, with a warning each. first: the accessor to begin with; those before it are
/// valid.
std::optional<Error> validateAccessors(tinygltf::Model& model, std::size_t first, MemoryBudget& budget, Report& report);

/// Nodes form trees (glTF 2.0, section 3.5.2): no cycle, no node with two parents, no branch of more than maxDepth
/// nodes. The nodes of each scene are roots, each named once (3.5.1). A skin (3.7.3) names each joint once and has an
/// inverse bind matrix for each. Warns of joints in several trees or outside the scene of their mesh, and of matrices
/// whose last row is not 0 0 0 1.
std::optional<Error> validateNodes(const tinygltf::Model& model, std::size_t maxDepth, Report& report);

/// Animations (glTF 2.0, section 3.11): key times are floats, outputs have the type of their path and as many values as
/// the times, the interpolation and the morph targets need. Rotations of length 0 are mended in data of our own. Warns
/// of nodes that have a matrix. readClips() checks the order of the times.
std::optional<Error> validateAnimations(tinygltf::Model& model, Report& report);

/// Primitives (glTF 2.0, section 3.7.2): attributes and morph targets have the types that they may have and one value a
/// vertex, indices are integers below the number of vertices, joints come with weights, node weights fit the targets.
/// Warns of incomplete triangles and of textures whose coordinates a primitive lacks. Many primitives can share one
/// accessor, so all their reads together are limited to budget.limit() bytes, which bounds the time.
///
/// Skinning (section 3.7.3.3): a vertex names joints of every skin that its mesh is used with. This is the one place
/// that mends influences, in data of our own: weights that are negative or do not sum to 1 (without a warning where the
/// sum is off by at most 2 %), joint numbers beyond the skin that have no weight. A node loses its skin, with a
/// warning, if its mesh has no joints.
std::optional<Error> validateMeshes(tinygltf::Model& model, MemoryBudget& budget, Report& report);

} // namespace osgGpuAnimation::gltf
