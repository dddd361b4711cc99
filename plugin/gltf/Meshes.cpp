// SPDX-License-Identifier: MIT
#include "gltf/Meshes.h"

#include "gltf/Accessor.h"
#include "gltf/FlatMesh.h"
#include "gltf/FlatNormals.h"
#include "gltf/NamedElement.h"
#include "gltf/Reach.h"
#include "gltf/VertexAttributes.h"
#include "gltf/VertexCache.h"

#include <numeric>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr int modeTriangles = 4;

template <typename Array>
void pick(osg::ref_ptr<Array>& array, const std::vector<std::uint32_t>& vertices)
{
    if (!array) return;
    osg::ref_ptr<Array> picked = new Array(osg::Array::BIND_PER_VERTEX);
    picked->reserve(vertices.size());
    for (const std::uint32_t vertex : vertices)
        picked->push_back((*array)[vertex]);
    array = picked;
}

/// Vertices that make whole points, lines or triangles.
std::size_t wholeCount(int mode, std::size_t count)
{
    switch (mode)
    {
    case 0:
        return count;
    case 1:
        return count - count % 2;
    case 2:
    case 3:
        return count < 2 ? 0 : count;
    case modeTriangles:
        return count - count % 3;
    default:
        return count < 3 ? 0 : count;
    }
}

template <typename Elements>
osg::ref_ptr<osg::PrimitiveSet> makeElements(GLenum mode, const std::vector<std::uint32_t>& indices)
{
    osg::ref_ptr<Elements> elements = new Elements(mode);
    elements->reserve(indices.size());
    for (const std::uint32_t index : indices)
        elements->push_back(static_cast<typename Elements::value_type>(index));
    return elements;
}

osg::ref_ptr<osg::PrimitiveSet> makePrimitiveSet(int mode, const std::vector<std::uint32_t>& indices,
                                                 std::size_t vertexCount)
{
    const auto glMode = static_cast<GLenum>(mode); // the same numbers in both
    if (indices.empty()) return new osg::DrawArrays(glMode, 0, static_cast<GLsizei>(wholeCount(mode, vertexCount)));
    return vertexCount <= 65535 ? makeElements<osg::DrawElementsUShort>(glMode, indices)
                                : makeElements<osg::DrawElementsUInt>(glMode, indices);
}

/// The vertices in the order in which they are drawn, whole triangles only; empty where no indices say so.
std::vector<std::uint32_t> readIndices(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    std::vector<std::uint32_t> indices;
    if (primitive.indices >= 0) indices = readIntegers(model, primitive.indices);
    indices.resize(wholeCount(primitive.mode, indices.size()));
    return indices;
}

bool isBlended(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    return primitive.material >= 0 &&
           model.materials[static_cast<std::size_t>(primitive.material)].alphaMode == "BLEND";
}

/// The way back of `sourceVertex`, to the first of several. Vertices that no triangle uses are appended to it, so that
/// all of the file's are there to be asked for, if not drawn.
std::vector<std::uint32_t> invert(std::vector<std::uint32_t>& sourceVertex, std::size_t vertexCount)
{
    std::vector<std::uint32_t> geometryVertex(vertexCount, UINT32_MAX);
    for (std::size_t i = sourceVertex.size(); i-- > 0;)
        geometryVertex[sourceVertex[i]] = static_cast<std::uint32_t>(i);
    for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
    {
        if (geometryVertex[vertex] != UINT32_MAX) continue;
        geometryVertex[vertex] = static_cast<std::uint32_t>(sourceVertex.size());
        sourceVertex.push_back(static_cast<std::uint32_t>(vertex));
    }
    return geometryVertex;
}

void pickVertices(MeshPrimitive& mesh)
{
    pick(mesh.positions, mesh.sourceVertex);
    pick(mesh.texCoords, mesh.sourceVertex);
    pick(mesh.colors, mesh.sourceVertex);
    for (MorphTarget& target : mesh.targets)
    {
        pick(target.positions, mesh.sourceVertex);
        pick(target.normals, mesh.sourceVertex);
        pick(target.colors, mesh.sourceVertex);
        pick(target.textureCoordinates, mesh.sourceVertex);
    }
}

/// indices: none where the vertices are drawn in their order.
std::vector<std::uint32_t> cornersOf(const MeshPrimitive& mesh, int mode, std::vector<std::uint32_t> indices)
{
    if (indices.empty())
    {
        indices.resize(mesh.vertexCount);
        std::iota(indices.begin(), indices.end(), 0u);
    }
    return triangleCorners(mode, indices);
}

/// Makes one vertex of those that differ in nothing.
void join(MeshPrimitive& mesh, const tinygltf::Model& model, const tinygltf::Primitive& primitive,
          std::vector<std::uint32_t> indices)
{
    std::vector<std::uint32_t> corners = cornersOf(mesh, primitive.mode, std::move(indices));
    JoinedVertices joined = joinVertices(model, primitive, mesh);
    for (std::uint32_t& corner : corners)
        corner = joined.vertexOf[corner];
    mesh.sourceVertex.resize(joined.count);
    for (std::size_t vertex = mesh.vertexCount; vertex-- > 0;)
        mesh.sourceVertex[joined.vertexOf[vertex]] = static_cast<std::uint32_t>(vertex);
    mesh.geometryVertex = std::make_shared<std::vector<std::uint32_t>>(std::move(joined.vertexOf));
    pickVertices(mesh);
    if (!isBlended(model, primitive)) optimizeForVertexCache(corners, joined.count);
    mesh.primitiveSet = makePrimitiveSet(modeTriangles, corners, joined.count);
    mesh.normals = smoothNormals(*mesh.positions, corners);
    mesh.isFlat = true;
}

/// Gives every triangle vertices of its own, with its own normal.
void takeApart(MeshPrimitive& mesh, int mode, std::vector<std::uint32_t> indices)
{
    std::vector<std::uint32_t> corners = cornersOf(mesh, mode, std::move(indices));
    mesh.primitiveSet = new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size()));
    bool same = corners.size() == mesh.vertexCount;
    for (std::size_t i = 0; i < corners.size() && same; ++i)
        same = corners[i] == i;
    if (!same)
    {
        mesh.sourceVertex = std::move(corners);
        mesh.geometryVertex = std::make_shared<std::vector<std::uint32_t>>(invert(mesh.sourceVertex, mesh.vertexCount));
        pickVertices(mesh);
    }
    mesh.normals = flatNormals(*mesh.positions);
    mesh.isFlat = true;
}

bool isFlat(const tinygltf::Primitive& primitive)
{
    return primitive.mode >= modeTriangles && primitive.attributes.count("NORMAL") == 0;
}

/// An upper bound of what reading takes, influences included.
std::size_t byteSize(const tinygltf::Model& model, const tinygltf::Primitive& primitive, std::size_t vertexCount)
{
    constexpr std::size_t aVertex = sizeof(osg::Vec3) * 2 + sizeof(osg::Vec2) + sizeof(osg::Vec4) + 2 * 24 + 8;
    const std::size_t aTarget = sizeof(osg::Vec3) * 2 + sizeof(osg::Vec4) + sizeof(osg::Vec2);
    const std::size_t indices =
        primitive.indices < 0 ? 0 : model.accessors[static_cast<std::size_t>(primitive.indices)].count;
    const std::size_t corners =
        !isFlat(primitive) ? 0 : (primitive.mode == modeTriangles ? 1 : 3) * (indices ? indices : vertexCount);
    return (vertexCount + corners) * (aVertex + aTarget * primitive.targets.size()) + 3 * 4 * indices;
}

} // namespace

Meshes::Meshes(const tinygltf::Model& model, DecodedBytes& budget, Report& report)
    : _model(model), _budget(budget), _report(report)
{
}

const MeshPrimitive* Meshes::primitive(int mesh, int primitive, bool skinned)
{
    const tinygltf::Primitive& source =
        _model.meshes[static_cast<std::size_t>(mesh)].primitives[static_cast<std::size_t>(primitive)];
    const bool joined = skinned && isFlat(source);
    const auto [place, isNew] = _primitives.try_emplace({mesh, primitive, joined});
    if (isNew) place->second = read(mesh, primitive, joined);
    return place->second ? &*place->second : nullptr;
}

std::optional<MeshPrimitive> Meshes::read(int meshIndex, int primitiveIndex, bool joined)
{
    const tinygltf::Mesh& source = _model.meshes[static_cast<std::size_t>(meshIndex)];
    const tinygltf::Primitive& primitive = source.primitives[static_cast<std::size_t>(primitiveIndex)];
    MeshPrimitive mesh;
    mesh.label = namedElement("meshes", static_cast<std::size_t>(meshIndex), source.name) + ".primitives[" +
                 std::to_string(primitiveIndex) + "]";
    const auto refuse = [&](const std::string& why) -> std::optional<MeshPrimitive>
    {
        _report.warn(mesh.label + ": " + why + "; not drawn");
        return std::nullopt;
    };
    const int positions = findAccessor(_model, primitive.attributes, "POSITION", {3});
    if (positions < 0) return refuse("no POSITION");
    if (primitive.mode < 0 || primitive.mode > 6) return refuse("mode " + std::to_string(primitive.mode));
    mesh.vertexCount = _model.accessors[static_cast<std::size_t>(positions)].count;
    const std::size_t bytes = byteSize(_model, primitive, mesh.vertexCount);
    if (!_budget.take(bytes))
        return refuse("it would take " + std::to_string(bytes) + " bytes, " + _budget.limitText());

    std::vector<std::uint32_t> indices = readIndices(_model, primitive);
    if (primitive.indices >= 0 ? indices.empty() : wholeCount(primitive.mode, mesh.vertexCount) == 0)
        return refuse("too few vertices for one element of mode " + std::to_string(primitive.mode));
    mesh.positions = readVectors(_model, primitive.attributes, "POSITION");
    mesh.normals = readVectors(_model, primitive.attributes, "NORMAL");
    mesh.texCoords = readTextureCoordinates(_model, primitive);
    mesh.colors = readColors(_model, primitive);
    mesh.targets = readMorphTargets(_model, primitive);
    mesh.radius = radiusOf(*mesh.positions);
    for (const MorphTarget& target : mesh.targets)
        mesh.targetRadii.push_back(target.positions ? radiusOf(*target.positions) : 0.0);
    if (!mesh.normals && primitive.mode >= modeTriangles)
    {
        if (joined)
            join(mesh, _model, primitive, std::move(indices));
        else
            takeApart(mesh, primitive.mode, std::move(indices));
        return mesh;
    }
    if (primitive.mode == modeTriangles && !isBlended(_model, primitive))
        optimizeForVertexCache(indices, mesh.vertexCount);
    mesh.primitiveSet = makePrimitiveSet(primitive.mode, indices, mesh.vertexCount);
    return mesh;
}

} // namespace osgGpuAnimation::gltf
