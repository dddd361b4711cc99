// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// An attribute of a Draco mesh, read as numbers of a glTF component type.
struct DracoAttribute
{
    std::string name; ///< for messages
    std::uint32_t uniqueId = 0;
    int accessor = -1;        ///< of the file
    std::size_t vertices = 0; ///< as the accessor has them, and the next two
    std::size_t components = 0;
    int componentType = 0;               ///< 5120 …
    std::vector<unsigned char> values{}; ///< the result, vertex after vertex
};

/// Decodes a mesh of exactly `faces` triangles from Draco's bit stream (KHR_draco_mesh_compression requires version
/// 2.2): fills the attributes' values and returns three indices per triangle. The header is checked before any memory
/// is allocated. The only exported function of the library that links Draco, see plugin/CMakeLists.txt. Errors, which
/// begin with `name`: no such stream, another number of triangles or vertices, faulty data; there is no such attribute,
/// it has another number of components, a value does not fit.
Result<std::vector<std::uint32_t>> decodeDraco(const unsigned char* data, std::size_t bytes, std::size_t faces,
                                               const std::string& name, std::vector<DracoAttribute>& attributes);

} // namespace osgGpuAnimation::gltf
