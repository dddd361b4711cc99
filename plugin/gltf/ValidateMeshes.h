// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Primitives (glTF 2.0, section 3.7.2): attributes and morph targets have the types that they may have and one value a
/// vertex, indices are integers below the number of vertices, joints come with weights, node weights fit the targets.
/// Warns of incomplete triangles and of textures whose coordinates a primitive lacks.
/// Returns the first fault, for which the document must be refused.
/// budget: what all primitives together may read; many may share one accessor.
std::optional<Error> validateMeshes(const tinygltf::Model& model, DecodedBytes budget, Report& report);

} // namespace osgGpuAnimation::gltf
