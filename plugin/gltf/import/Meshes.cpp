// SPDX-License-Identifier: MIT
#include "gltf/import/Meshes.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/Meshoptimizer.h"
#include "gltf/data/VertexAttributes.h"
#include "gltf/file/Elements.h"
#include "gltf/import/TriangleMesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr int modeTriangles = 4;

/// The largest distance of the points from the origin; infinite for NaN.
double radiusOf(const osg::Vec3Array& points)
{
    double farthest = 0.0;
    for (const osg::Vec3& point : points)
    {
        const double squared = osg::Vec3d(point).length2();
        if (!(squared <= farthest)) farthest = std::isnan(squared) ? std::numeric_limits<double>::infinity() : squared;
    }
    return std::sqrt(farthest);
}

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

/// Zero without POSITION.
std::size_t vertexCountOf(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    const auto positions = primitive.attributes.find("POSITION");
    return positions == primitive.attributes.end() ? 0 : elementOf(model.accessors, positions->second).count;
}

/// The indices or vertices of whole points, lines or triangles.
std::size_t drawnCount(const tinygltf::Model& model, const tinygltf::Primitive& primitive)
{
    const std::size_t vertices = vertexCountOf(model, primitive);
    if (vertices == 0 || primitive.indices < 0) return wholeCount(primitive.mode, vertices);
    return wholeCount(primitive.mode, elementOf(model.accessors, primitive.indices).count);
}

/// Appends the indices of whole points, lines or triangles; 0, 1, 2, … where the primitive has none.
void appendIndices(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                   std::vector<std::uint32_t>& indices)
{
    const std::size_t before = indices.size();
    const auto count = static_cast<std::ptrdiff_t>(drawnCount(model, primitive));
    indices.resize(before + static_cast<std::size_t>(count));
    const auto added = indices.begin() + static_cast<std::ptrdiff_t>(before);
    if (primitive.indices < 0) return std::iota(added, indices.end(), 0u);
    const std::vector<std::uint32_t> read = readIntegers(model, primitive.indices);
    std::copy(read.begin(), read.begin() + count, added);
}

bool isList(int mode)
{
    return mode == 0 || mode == 1 || mode == modeTriangles;
}

/// Primitives with equal keys have the same vertices and look alike in all variants.
struct GroupKey
{
    const tinygltf::Primitive* primitive;
    PrimitiveMaterials materials;

    auto values() const
    {
        return std::tie(primitive->mode, materials.own, primitive->attributes, primitive->targets, materials.ofVariant,
                        materials.withoutCoordinates);
    }
    bool operator<(const GroupKey& other) const { return values() < other.values(); }
};

/// The inverse of `sourceVertex`: the first vertex made from each of the file's. Appends the vertices that no triangle
/// uses to `sourceVertex`, so that every vertex of the file exists, drawn or not.
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

/// Calls visit(array) for each array of the file's vertices, null or not.
template <typename Visitor>
void visitArrays(MeshPrimitive& mesh, const Visitor& visit)
{
    visit(mesh.positions);
    visit(mesh.texCoords);
    visit(mesh.moreCoordinates);
    visit(mesh.tangents);
    visit(mesh.colors);
    for (MorphTarget& target : mesh.targets)
    {
        visit(target.positions);
        visit(target.normals);
        visit(target.colors);
        visit(target.textureCoordinates);
        visit(target.tangents);
    }
}

/// Welds vertices whose attributes are all equal: those that the mesh has read and the file's influences.
WeldedVertices weld(const tinygltf::Model& model, const tinygltf::Primitive& primitive, MeshPrimitive& mesh)
{
    std::vector<VertexStream> streams;
    visitArrays(mesh,
                [&](const auto& array)
                {
                    if (array) streams.push_back({array->getDataPointer(), array->getElementSize()});
                });
    const std::vector<FileInfluences> influences = readFileInfluences(model, primitive);
    for (const FileInfluences& set : influences)
    {
        streams.push_back({set.joints.data(), 4 * sizeof(std::uint32_t)});
        streams.push_back({set.weights.data(), 4 * sizeof(float)});
    }
    return weldVertices(streams, mesh.vertexCount);
}

/// indices: empty where the primitive has none.
std::vector<std::uint32_t> cornersOf(const MeshPrimitive& mesh, int mode, std::vector<std::uint32_t> indices)
{
    if (indices.empty())
    {
        indices.resize(mesh.vertexCount);
        std::iota(indices.begin(), indices.end(), 0u);
    }
    return triangleCorners(mode, indices);
}

/// Welds equal vertices, for a program that computes the normals of the faces.
void makeSmooth(MeshPrimitive& mesh, const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                std::vector<std::uint32_t> indices, bool isBlended)
{
    std::vector<std::uint32_t> corners = cornersOf(mesh, primitive.mode, std::move(indices));
    WeldedVertices welded = weld(model, primitive, mesh);
    for (std::uint32_t& corner : corners)
        corner = welded.vertexOf[corner];
    mesh.sourceVertex.resize(welded.count);
    for (std::size_t vertex = mesh.vertexCount; vertex-- > 0;)
        mesh.sourceVertex[welded.vertexOf[vertex]] = static_cast<std::uint32_t>(vertex);
    mesh.geometryVertex = std::make_shared<std::vector<std::uint32_t>>(std::move(welded.vertexOf));
    visitArrays(mesh, [&](auto& array) { pick(array, mesh.sourceVertex); });
    if (!isBlended) optimizeForVertexCache(corners, welded.count);
    mesh.primitiveSet = makePrimitiveSet(modeTriangles, corners, welded.count);
    mesh.normals = smoothNormals(*mesh.positions, corners);
    mesh.isFlat = true;
}

/// Gives every triangle vertices of its own, with its own normal.
void makeFlat(MeshPrimitive& mesh, int mode, std::vector<std::uint32_t> indices)
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
        visitArrays(mesh, [&](auto& array) { pick(array, mesh.sourceVertex); });
    }
    mesh.normals = flatNormals(*mesh.positions);
    mesh.isFlat = true;
}

bool isFlat(const tinygltf::Primitive& primitive)
{
    return primitive.mode >= modeTriangles && primitive.attributes.count("NORMAL") == 0;
}

/// An upper bound of the memory that reading a vertex needs, influences included.
std::size_t bytesAVertex(const tinygltf::Primitive& primitive)
{
    constexpr std::size_t alone = sizeof(osg::Vec3) * 2 + sizeof(osg::Vec2) + 3 * sizeof(osg::Vec4) + 2 * 24 + 8;
    constexpr std::size_t aTarget = sizeof(osg::Vec3) * 3 + sizeof(osg::Vec4) + sizeof(osg::Vec2);
    return alone + aTarget * primitive.targets.size();
}

/// The same for its indices, and for the vertices that flat normals need. hasIndices: in memory, not in the file.
std::size_t bytesOfIndices(const tinygltf::Model& model, const tinygltf::Primitive& primitive, bool hasIndices)
{
    const std::size_t count =
        primitive.indices < 0 ? vertexCountOf(model, primitive) : elementOf(model.accessors, primitive.indices).count;
    const std::size_t corners = !isFlat(primitive) ? 0 : (primitive.mode == modeTriangles ? 1 : 3) * count;
    return corners * bytesAVertex(primitive) + (hasIndices ? 3 * sizeof(std::uint32_t) * count : 0);
}

std::string labelOf(const tinygltf::Mesh& mesh, int meshIndex, int primitive)
{
    return namedElement("meshes", meshIndex, mesh.name) + '.' + elementName("primitives", primitive);
}

} // namespace

const MeshPrimitive* Meshes::primitive(int mesh, int primitive, bool skinned)
{
    const tinygltf::Primitive& source = elementOf(elementOf(_model.meshes, mesh).primitives, primitive);
    const bool welded = skinned && isFlat(source);
    const auto [place, isNew] = _primitives.try_emplace({mesh, primitive, welded});
    if (isNew) place->second = read(mesh, primitive, welded);
    return place->second ? &*place->second : nullptr;
}

/// Colours, texture coordinates, tangents and morph targets.
void Meshes::readSurface(const tinygltf::Primitive& primitive, const PrimitiveMaterials& materials, MeshPrimitive& mesh)
{
    for (std::size_t number = 0; number < materials.coordinates.size(); ++number)
    {
        const osg::ref_ptr<osg::Vec2Array> read =
            readTextureCoordinates(_model, primitive.attributes, materials.coordinates[number]);
        if (!read) continue;
        mesh.coordinates |= 1u << number;
        if (number == 0)
        {
            mesh.texCoords = read;
            continue;
        }
        if (!mesh.moreCoordinates)
            mesh.moreCoordinates =
                new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(read->size()));
        for (std::size_t vertex = 0; vertex < read->size(); ++vertex)
            for (int i = 0; i < 2; ++i)
                (*mesh.moreCoordinates)[vertex][2 * (static_cast<int>(number) - 1) + i] = (*read)[vertex][i];
    }
    const bool wantsTangents = mesh.normals && materials.hasNormalMap;
    if (wantsTangents) mesh.tangents = readTangents(_model, primitive);
    const auto hasLength = [](const osg::Vec4& tangent)
    { return tangent.x() != 0.0f || tangent.y() != 0.0f || tangent.z() != 0.0f; };
    if (mesh.tangents && !std::all_of(mesh.tangents->begin(), mesh.tangents->end(), hasLength))
    {
        _report.warn(mesh.label + ": TANGENT: expected directions, found one of length 0; the normal map "
                                  "follows the texture coordinates");
        mesh.tangents = nullptr;
    }
    mesh.colors = readColors(_model, primitive);
    mesh.targets =
        readMorphTargets(_model, primitive, mesh.texCoords ? &materials.coordinates.front() : nullptr, wantsTangents);
}

const Meshes::Groups& Meshes::groupsOf(int mesh)
{
    const auto [place, isNew] = _groups.try_emplace(mesh);
    Groups& groups = place->second;
    if (!isNew) return groups;
    std::map<GroupKey, std::size_t> latest;
    for (const tinygltf::Primitive& primitive : elementOf(_model.meshes, mesh).primitives)
    {
        const std::size_t number = groups.next.size();
        groups.next.push_back(-1);
        GroupKey key{&primitive, materialsOf(_model, primitive, _maps)};
        std::size_t before = number;
        if (isList(primitive.mode) && !key.materials.isTransparent)
            before = std::exchange(latest.try_emplace(std::move(key), number).first->second, number);
        if (before == number)
            groups.firsts.push_back(static_cast<int>(number));
        else
            groups.next[before] = static_cast<int>(number);
    }
    return groups;
}

/// Returns the indices of all primitives that are drawn together with the first; none where a single one has none.
/// Those that exceed the memory budget are left out, with a warning each. outPrimitives: the others; none if nothing
/// can be drawn.
std::vector<std::uint32_t> Meshes::readGroup(int meshIndex, int first, std::vector<int>& outPrimitives)
{
    const tinygltf::Mesh& mesh = elementOf(_model.meshes, meshIndex);
    const Groups& groups = groupsOf(meshIndex);
    const bool isAlone = elementOf(groups.next, first) < 0;
    const tinygltf::Primitive& alike = elementOf(mesh.primitives, first);
    std::size_t bytesOfVertices = vertexCountOf(_model, alike) * bytesAVertex(alike);
    std::vector<std::uint32_t> indices;
    for (int number = first; number >= 0; number = elementOf(groups.next, number))
    {
        const tinygltf::Primitive& primitive = elementOf(mesh.primitives, number);
        if (drawnCount(_model, primitive) == 0) continue; // the validation has warned of it
        const bool hasIndices = !isAlone || primitive.indices >= 0;
        const std::size_t bytes = bytesOfVertices + bytesOfIndices(_model, primitive, hasIndices);
        if (!_budget.take(bytes))
        {
            _report.warn(labelOf(mesh, meshIndex, number) + ": it would take " + std::to_string(bytes) + " bytes, " +
                         _budget.limitText() + "; not drawn");
            continue;
        }
        bytesOfVertices = 0; // the others share them
        outPrimitives.push_back(number);
        if (hasIndices) appendIndices(_model, primitive, indices);
    }
    return indices;
}

std::optional<MeshPrimitive> Meshes::read(int meshIndex, int first, bool welded)
{
    std::vector<int> primitives;
    std::vector<std::uint32_t> indices = readGroup(meshIndex, first, primitives);
    if (primitives.empty()) return std::nullopt;
    const tinygltf::Mesh& source = elementOf(_model.meshes, meshIndex);
    const tinygltf::Primitive& primitive = elementOf(source.primitives, primitives.front());
    MeshPrimitive mesh;
    mesh.label = labelOf(source, meshIndex, primitives.front());
    if (primitives.size() > 1) mesh.label += " and " + std::to_string(primitives.size() - 1) + " more";
    mesh.primitives = std::make_shared<const std::vector<int>>(std::move(primitives));
    mesh.vertexCount = vertexCountOf(_model, primitive);
    mesh.positions = readVectors(_model, primitive.attributes, "POSITION");
    mesh.normals = readVectors(_model, primitive.attributes, "NORMAL");
    const PrimitiveMaterials materials = materialsOf(_model, primitive, _maps);
    readSurface(primitive, materials, mesh);
    mesh.radius = radiusOf(*mesh.positions);
    for (const MorphTarget& target : mesh.targets)
        mesh.targetRadii.push_back(target.positions ? radiusOf(*target.positions) : 0.0);
    if (!mesh.normals && primitive.mode >= modeTriangles)
    {
        if (welded)
            makeSmooth(mesh, _model, primitive, std::move(indices), materials.isBlended);
        else
            makeFlat(mesh, primitive.mode, std::move(indices));
        return mesh;
    }
    if (primitive.mode == modeTriangles && !materials.isBlended) optimizeForVertexCache(indices, mesh.vertexCount);
    mesh.primitiveSet = makePrimitiveSet(primitive.mode, indices, mesh.vertexCount);
    return mesh;
}

} // namespace osgGpuAnimation::gltf
