// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Vertices and skins fit together (glTF 2.0, section 3.7.3.3): a vertex names joints of every skin that its mesh is
/// used with. Mended, with a warning and in data of our own: weights that are negative or do not sum to 1, joint
/// numbers beyond the skin that have no weight. A skin on a mesh without joints is taken from the node, with a warning.
/// Returns the first fault, for which the document must be refused.
std::optional<Error> validateSkinning(tinygltf::Model& model, DecodedBytes& budget, Report& report);

} // namespace osgGpuAnimation::gltf
