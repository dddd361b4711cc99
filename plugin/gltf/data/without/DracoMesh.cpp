// SPDX-License-Identifier: MIT
#include "gltf/data/DracoMesh.h"

#include "gltf/file/Report.h"

namespace draco
{
class Mesh
{
};
} // namespace draco

namespace osgGpuAnimation::gltf
{

Result<DracoMesh> DracoMesh::decode(const unsigned char*, std::size_t, std::size_t)
{
    return missingLibrary("the primitive", "Draco");
}

// Not called: there is no such mesh.

DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;
DracoMesh& DracoMesh::operator=(DracoMesh&&) noexcept = default;
DracoMesh::~DracoMesh() = default;

std::size_t DracoMesh::vertices() const
{
    return 0;
}

std::vector<std::uint32_t> DracoMesh::indices() const
{
    return {};
}

Result<std::vector<unsigned char>> DracoMesh::attribute(std::uint32_t, std::size_t, int) const
{
    return std::vector<unsigned char>();
}

} // namespace osgGpuAnimation::gltf
