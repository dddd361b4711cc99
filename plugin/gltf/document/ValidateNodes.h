// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <tiny_gltf.h>

#include <cstddef>
#include <optional>

namespace osgGpuAnimation::gltf
{

/// Nodes form trees (glTF 2.0, section 3.5.2): no cycle, no node with two parents, no branch of more than mostDepth
/// nodes. The nodes of each scene are roots, each named once (3.5.1). A skin (3.7.3) names each joint once and has an
/// inverse bind matrix for each. Warns of joints in several trees or outside the scene of their mesh, and of matrices
/// whose last row is not 0 0 0 1.
/// Returns the first fault, for which the document must be refused.
std::optional<Error> validateNodes(const tinygltf::Model& model, std::size_t mostDepth, Report& report);

/// Animations (glTF 2.0, section 3.11): key times are floats that do not decrease, outputs have the type of their path
/// and as many values as the times, the interpolation and the morph targets need. Rotations of length 0 are mended
/// in data of our own. Warns of equal times, negative times and nodes that have a matrix. Returns the first fault, for
/// which the document must be refused.
std::optional<Error> validateAnimations(tinygltf::Model& model, Report& report);

} // namespace osgGpuAnimation::gltf
