// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/NodeForest.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// The nodes of each scene are roots, each named once (glTF 2.0, section 3.5.1). Returns the first fault, for which the
/// document must be refused.
std::optional<Error> validateScenes(const tinygltf::Model& model, const NodeForest& forest);

} // namespace osgGpuAnimation::gltf
