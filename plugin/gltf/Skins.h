// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Joints.h"

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// All skins of the file, under the file's numbers (glTF 2.0, section 3.7.3). Without inverseBindMatrices they are
/// identities. A skin that the validation emptied has no joints.
std::vector<Skin> readSkins(const tinygltf::Model& model, const Joints& joints);

} // namespace osgGpuAnimation::gltf
