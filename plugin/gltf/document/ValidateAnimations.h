// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>

namespace osgGpuAnimation::gltf
{

/// Animations (glTF 2.0, section 3.11): key times are floats that do not decrease, outputs have the type of their path
/// and as many values as the times, the interpolation and the morph targets ask for. Rotations of length 0 are mended
/// in data of our own. Warns of equal times, negative times and nodes that have a matrix. Returns the first fault, for
/// which the document must be refused.
std::optional<Error> validateAnimations(tinygltf::Model& model, Report& report);

} // namespace osgGpuAnimation::gltf
