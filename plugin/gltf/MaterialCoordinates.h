// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// One number a material: bit n is set where one of its textures reads TEXCOORD_n, KHR_texture_transform considered.
std::vector<std::uint32_t> materialCoordinates(const tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
