// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GlbWriter.h"
#include "gltf/file/Report.h"

#include <assimp/matrix4x4.h>

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

struct aiMesh;

namespace osgGpuAnimation::assimp
{

/// The glTF nodes by the names of Assimp's; the first node of each name.
using NodeNumbers = std::map<std::string, std::size_t>;

/// A mesh of the document and the skin that moves it.
struct WrittenMesh
{
    std::size_t mesh;
    std::optional<std::size_t> skin;
};

/// Writes Assimp's meshes as glTF's, with their skins and morph targets.
class MeshWriter
{
public:
    MeshWriter(const NodeNumbers& nodes, gltf::GlbWriter& writer, gltf::Report& report)
        : _nodes(nodes), _writer(writer), _report(report)
    {
    }

    /// Several meshes become primitives of one; none may have bones or morph targets then.
    /// node: whose meshes they are; vertices without bones follow it. None: there is nothing to draw.
    std::optional<WrittenMesh> write(const std::vector<const aiMesh*>& meshes, std::size_t node);

private:
    /// A mesh's four bones a vertex, as indices of its skin's joints.
    struct Influences
    {
        std::vector<std::uint16_t> joints;
        std::vector<float> weights;
        std::size_t skin;
    };

    nlohmann::json primitive(const aiMesh& mesh);
    void addTargets(const aiMesh& mesh, nlohmann::json& made);
    Influences influences(const aiMesh& mesh, std::size_t node);
    std::size_t addSkin(const aiMesh& mesh, std::vector<std::size_t> joints, std::vector<float> inverseBindMatrices);
    std::vector<float> finite(std::vector<float> values, const aiMesh& mesh);

    const NodeNumbers& _nodes;
    gltf::GlbWriter& _writer;
    gltf::Report& _report;
    std::map<const aiMesh*, nlohmann::json> _primitives;
    std::map<std::pair<std::vector<std::size_t>, std::vector<float>>, std::size_t> _skins;
};

/// As glTF has matrices.
std::array<float, 16> columnMajor(const aiMatrix4x4& matrix);

/// True where the mesh needs a glTF mesh of its own: it has bones or morph targets.
bool standsAlone(const aiMesh& mesh);

} // namespace osgGpuAnimation::assimp
