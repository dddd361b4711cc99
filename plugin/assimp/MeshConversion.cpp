// SPDX-License-Identifier: MIT
#include "assimp/MeshConversion.h"

#include <assimp/mesh.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGpuAnimation::assimp
{

namespace
{

using nlohmann::json;

constexpr std::size_t maxJoints = 65535; // of a skin, by JOINTS_0

std::vector<float> components(const aiVector3D* vectors, std::size_t count)
{
    std::vector<float> values;
    values.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i)
        values.insert(values.end(), {vectors[i].x, vectors[i].y, vectors[i].z});
    return values;
}

/// 0: no primitive that glTF has.
unsigned int cornersOf(const aiMesh& mesh)
{
    return mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE ? 3
           : mesh.mPrimitiveTypes & aiPrimitiveType_LINE   ? 2
           : mesh.mPrimitiveTypes & aiPrimitiveType_POINT  ? 1
                                                           : 0;
}

std::vector<std::uint32_t> indicesOf(const aiMesh& mesh)
{
    const unsigned int corners = cornersOf(mesh);
    std::vector<std::uint32_t> indices;
    for (unsigned int i = 0; i < mesh.mNumFaces; ++i)
    {
        const aiFace& face = mesh.mFaces[i];
        const auto isVertex = [&](unsigned int index) { return index < mesh.mNumVertices; };
        if (face.mNumIndices == corners && std::all_of(face.mIndices, face.mIndices + corners, isVertex))
            indices.insert(indices.end(), face.mIndices, face.mIndices + corners);
    }
    return indices;
}

/// Normals of length 0 have no direction; glTF asks for unit length (2.0, section 3.7.2.1).
std::vector<float> unitVectors(const aiVector3D* vectors, std::size_t count)
{
    std::vector<aiVector3D> units(vectors, vectors + count);
    for (aiVector3D& each : units)
        each = each.SquareLength() > 0.0f ? each.NormalizeSafe() : aiVector3D(0.0f, 0.0f, 1.0f);
    return components(units.data(), count);
}

std::vector<float> tangentsOf(const aiMesh& mesh)
{
    std::vector<float> values;
    for (unsigned int i = 0; i < mesh.mNumVertices; ++i)
    {
        aiVector3D tangent = mesh.mTangents[i];
        tangent.NormalizeSafe();
        // Assimp's bitangent follows v, which goes up there and down in glTF.
        const float side = (mesh.mNormals[i] ^ mesh.mTangents[i]) * mesh.mBitangents[i] < 0.0f ? -1.0f : 1.0f;
        values.insert(values.end(), {tangent.x, tangent.y, tangent.z, side});
    }
    return values;
}

} // namespace

std::array<float, 16> columnMajor(const aiMatrix4x4& matrix)
{
    std::array<float, 16> numbers;
    for (unsigned int i = 0; i < 16; ++i)
        numbers[i] = matrix[i % 4][i / 4];
    return numbers;
}

bool standsAlone(const aiMesh& mesh)
{
    return mesh.mNumBones > 0 || mesh.mNumAnimMeshes > 0;
}

std::optional<WrittenMesh> MeshWriter::write(const std::vector<const aiMesh*>& meshes, std::size_t node)
{
    json primitives = json::array();
    std::optional<std::size_t> skin;
    for (const aiMesh* mesh : meshes)
    {
        auto known = _primitives.find(mesh);
        if (known == _primitives.end()) known = _primitives.emplace(mesh, primitive(*mesh)).first;
        if (known->second.is_null()) continue;
        json made = known->second;
        if (mesh->mNumBones > 0)
        {
            const Influences bones = influences(*mesh, node);
            made["attributes"]["JOINTS_0"] = _writer.addJoints(bones.joints);
            made["attributes"]["WEIGHTS_0"] = _writer.addFloats(bones.weights, "VEC4", gltf::GlbWriter::Use::Values);
            skin = bones.skin;
        }
        primitives.push_back(std::move(made));
    }
    if (primitives.empty()) return std::nullopt;
    const aiMesh& first = *meshes.front();
    json mesh{{"name", first.mName.C_Str()}, {"primitives", std::move(primitives)}};
    for (unsigned int i = 0; i < first.mNumAnimMeshes; ++i)
    {
        const float weight = first.mAnimMeshes[i]->mWeight;
        mesh["weights"].push_back(std::isfinite(weight) ? weight : 0.0f);
        mesh["extras"]["targetNames"].push_back(first.mAnimMeshes[i]->mName.C_Str());
    }
    return WrittenMesh{gltf::append(_writer.document["meshes"], std::move(mesh)), skin};
}

json MeshWriter::primitive(const aiMesh& mesh)
{
    const std::vector<std::uint32_t> indices = indicesOf(mesh);
    if (!mesh.HasPositions() || indices.empty()) return {};
    const auto vertices = [&](const std::vector<float>& values, const char* type)
    { return _writer.addFloats(finite(values, mesh), type, gltf::GlbWriter::Use::Vertices); };
    constexpr int triangles = 4, lines = 1, points = 0;
    const unsigned int corners = cornersOf(mesh);
    json made{{"mode", corners == 3 ? triangles : corners == 2 ? lines : points}, {"material", mesh.mMaterialIndex}};
    json& attributes = made["attributes"] = json::object();
    attributes["POSITION"] = vertices(components(mesh.mVertices, mesh.mNumVertices), "VEC3");
    if (mesh.HasNormals()) attributes["NORMAL"] = vertices(unitVectors(mesh.mNormals, mesh.mNumVertices), "VEC3");
    if (mesh.HasNormals() && mesh.HasTangentsAndBitangents())
        attributes["TANGENT"] = vertices(tangentsOf(mesh), "VEC4");
    for (unsigned int set = 0; set < mesh.GetNumUVChannels(); ++set)
    {
        std::vector<float> coordinates;
        for (unsigned int i = 0; i < mesh.mNumVertices; ++i)
            coordinates.insert(coordinates.end(),
                               {mesh.mTextureCoords[set][i].x, 1.0f - mesh.mTextureCoords[set][i].y});
        attributes["TEXCOORD_" + std::to_string(set)] = vertices(coordinates, "VEC2");
    }
    if (mesh.HasVertexColors(0))
    {
        std::vector<float> colors;
        for (unsigned int i = 0; i < mesh.mNumVertices; ++i)
            for (unsigned int channel = 0; channel < 4; ++channel)
                colors.push_back(std::clamp(mesh.mColors[0][i][channel], 0.0f, 1.0f));
        attributes["COLOR_0"] = vertices(colors, "VEC4");
    }
    made["indices"] = _writer.addIndices(indices);
    addTargets(mesh, made);
    return made;
}

void MeshWriter::addTargets(const aiMesh& mesh, json& made)
{
    for (unsigned int i = 0; i < mesh.mNumAnimMeshes; ++i)
    {
        const aiAnimMesh& target = *mesh.mAnimMeshes[i];
        json attributes = json::object();
        const auto add = [&](const char* name, const aiVector3D* morphed, const aiVector3D* base)
        {
            if (target.mNumVertices != mesh.mNumVertices || !morphed || !base) return;
            std::vector<aiVector3D> deltas(morphed, morphed + mesh.mNumVertices);
            for (std::size_t vertex = 0; vertex < deltas.size(); ++vertex)
                deltas[vertex] -= base[vertex];
            attributes[name] = _writer.addFloats(finite(components(deltas.data(), deltas.size()), mesh), "VEC3",
                                                 gltf::GlbWriter::Use::Vertices);
        };
        add("POSITION", target.mVertices, mesh.mVertices);
        add("NORMAL", target.mNormals, mesh.mNormals);
        made["targets"].push_back(std::move(attributes));
    }
}

MeshWriter::Influences MeshWriter::influences(const aiMesh& mesh, std::size_t node)
{
    std::vector<std::size_t> joints;
    std::vector<float> inverseBindMatrices;
    const auto addJoint = [&](std::size_t joint, const aiMatrix4x4& inverseBind)
    {
        joints.push_back(joint);
        const std::array<float, 16> numbers = columnMajor(inverseBind);
        inverseBindMatrices.insert(inverseBindMatrices.end(), numbers.begin(), numbers.end());
        return static_cast<std::uint16_t>(joints.size() - 1);
    };
    const std::size_t count = mesh.mNumVertices;
    Influences made{std::vector<std::uint16_t>(4 * count), std::vector<float>(4 * count), 0};
    std::vector<unsigned char> taken(count);
    for (unsigned int i = 0; i < mesh.mNumBones; ++i)
    {
        const aiBone& bone = *mesh.mBones[i];
        const auto found = _nodes.find(bone.mName.C_Str());
        if (found == _nodes.end() || joints.size() + 1 >= maxJoints)
        {
            _report.warn("mesh " + gltf::quoted(std::string(mesh.mName.C_Str())) + ": bone " +
                         gltf::quoted(std::string(bone.mName.C_Str())) +
                         " is no node of the scene, or one too many; it moves nothing");
            continue;
        }
        const std::uint16_t joint = addJoint(found->second, bone.mOffsetMatrix);
        for (unsigned int w = 0; w < bone.mNumWeights; ++w)
        {
            const aiVertexWeight& weight = bone.mWeights[w];
            if (weight.mVertexId >= count || taken[weight.mVertexId] == 4 || !(weight.mWeight > 0.0f) ||
                !std::isfinite(weight.mWeight))
                continue;
            const std::size_t place = 4 * static_cast<std::size_t>(weight.mVertexId) + taken[weight.mVertexId]++;
            made.joints[place] = joint;
            made.weights[place] = weight.mWeight;
        }
    }
    std::optional<std::uint16_t> still; // vertices without bones stay where their node is
    for (std::size_t vertex = 0; vertex < count; ++vertex)
    {
        float* const weights = &made.weights[4 * vertex];
        const float sum = weights[0] + weights[1] + weights[2] + weights[3];
        if (sum > 0.0f)
        {
            std::transform(weights, weights + 4, weights, [sum](float weight) { return weight / sum; });
            continue;
        }
        if (!still) still = addJoint(node, aiMatrix4x4());
        made.joints[4 * vertex] = *still;
        weights[0] = 1.0f;
    }
    made.skin = addSkin(mesh, std::move(joints), std::move(inverseBindMatrices));
    return made;
}

std::size_t MeshWriter::addSkin(const aiMesh& mesh, std::vector<std::size_t> joints,
                                std::vector<float> inverseBindMatrices)
{
    const auto key = std::make_pair(std::move(joints), finite(std::move(inverseBindMatrices), mesh));
    const auto known = _skins.find(key);
    if (known != _skins.end()) return known->second;
    const std::size_t matrices = _writer.addFloats(key.second, "MAT4", gltf::GlbWriter::Use::Values);
    return _skins[key] =
               gltf::append(_writer.document["skins"], {{"joints", key.first}, {"inverseBindMatrices", matrices}});
}

std::vector<float> MeshWriter::finite(std::vector<float> values, const aiMesh& mesh)
{
    bool isFinite = true;
    for (float& value : values)
        if (!std::isfinite(value))
        {
            isFinite = false;
            value = 0.0f;
        }
    if (!isFinite)
        _report.warn("mesh " + gltf::quoted(std::string(mesh.mName.C_Str())) +
                     ": numbers that are not finite are taken as 0");
    return values;
}

} // namespace osgGpuAnimation::assimp
