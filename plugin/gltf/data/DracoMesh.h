// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace draco
{
class Mesh;
}

namespace osgGpuAnimation::gltf
{

/// A mesh decoded from Draco's bit stream (KHR_draco_mesh_compression requires version 2.2). The only exported class of
/// the library that links Draco, see plugin/CMakeLists.txt.
class DracoMesh
{
public:
    /// Decodes a mesh of exactly `faces` triangles: the header is checked before any memory is allocated for them.
    /// Errors (`expected …, found …`): no such stream, another number of triangles, faulty data.
    static Result<DracoMesh> decode(const unsigned char* data, std::size_t bytes, std::size_t faces);

    DracoMesh(DracoMesh&&) noexcept;
    DracoMesh& operator=(DracoMesh&&) noexcept;
    ~DracoMesh();

    std::size_t vertices() const;
    /// Three per triangle.
    std::vector<std::uint32_t> indices() const;
    /// The values of an attribute, vertex after vertex, as numbers of a glTF component type (5120 …).
    /// Errors: there is no such attribute, it has another number of components, a value does not fit.
    Result<std::vector<unsigned char>> attribute(std::uint32_t uniqueId, std::size_t components,
                                                 int componentType) const;

private:
    explicit DracoMesh(std::unique_ptr<draco::Mesh> mesh);

    std::unique_ptr<draco::Mesh> _mesh;
};

} // namespace osgGpuAnimation::gltf
