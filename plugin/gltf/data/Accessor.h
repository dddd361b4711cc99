// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

// Reads accessors of a validated document (see TinyGltf.h) with strides, normalization and sparse substitution, in all
// component types (glTF 2.0, section 3.6.2). The model's buffers are never changed.

/// The numbers per element: 1 for SCALAR … 16 for MAT4; 0 for an unknown type.
std::size_t componentCount(const tinygltf::Accessor& accessor);
/// The bytes per number: 1, 2 or 4; 0 for a component type that glTF does not know.
std::size_t componentBytes(int componentType);
/// The bytes per element without stride; the columns of small matrices are padded to 4 bytes (section 3.6.2.4).
std::size_t elementBytes(const tinygltf::Accessor& accessor);
/// The same without the padding behind the last column, which the last element does not need.
std::size_t lastElementBytes(const tinygltf::Accessor& accessor);

/// accessor.count * componentCount() numbers, element after element, matrices column-major. Normalized integers become
/// [0, 1] or [-1, 1] (section 3.6.2.2, computed in double); others their plain value.
std::vector<double> readDoubles(const tinygltf::Model& model, int accessor);
std::vector<float> readFloats(const tinygltf::Model& model, int accessor);
/// For indices and joints: the integers as they are.
std::vector<std::uint32_t> readIntegers(const tinygltf::Model& model, int accessor);

/// One of packed indices of 1, 2 or 4 bytes.
std::size_t indexAt(const unsigned char* indices, std::size_t bytes, std::size_t i);

// Data of our own in a model: decompressed or mended. The file's buffers and accessors stay as they are, because other
// elements may refer to them.

/// Returns the number of a new buffer view with a buffer of its own. stride 0: tightly packed.
int addBufferView(tinygltf::Model& model, std::vector<unsigned char> bytes, std::size_t stride);

/// Returns the number of a new accessor of `type` (TINYGLTF_TYPE_…) over all the numbers.
int addAccessor(tinygltf::Model& model, const std::vector<float>& numbers, int type);
int addAccessor(tinygltf::Model& model, const std::vector<std::uint16_t>& numbers, int type);

} // namespace osgGpuAnimation::gltf
