// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

// Data of our own in a model: what was decompressed or mended. The file's buffers and accessors stay as they are, since
// others may refer to them.

/// Returns the number of a new buffer view with a buffer of its own. stride 0: tightly packed.
int addBufferView(tinygltf::Model& model, std::vector<unsigned char> bytes, std::size_t stride);

/// Returns the number of a new accessor of `type` (TINYGLTF_TYPE_…) over all the numbers.
int addAccessor(tinygltf::Model& model, const std::vector<float>& numbers, int type);
int addAccessor(tinygltf::Model& model, const std::vector<std::uint16_t>& numbers, int type);

} // namespace osgGpuAnimation::gltf
