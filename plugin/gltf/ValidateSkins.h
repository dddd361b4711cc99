// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/NodeForest.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Skins (glTF 2.0, section 3.7.3): each joint once, an inverse bind matrix for each. Warns of joints in several trees
/// or outside the scene that shows the mesh, and of matrices whose last row is not 0 0 0 1.
/// Returns the first fault, for which the document must be refused.
std::optional<Error> validateSkins(const tinygltf::Model& model, const NodeForest& forest, Report& report);

} // namespace osgGpuAnimation::gltf
