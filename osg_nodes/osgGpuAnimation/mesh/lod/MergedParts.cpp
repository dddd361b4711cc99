// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/lod/MergedParts.h>

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>

#include <layout.glsl>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <osgUtil/MeshOptimizers>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

/// True if the StateSets differ in what depends on the mesh at most, or in the material's name.
bool areAlike(const osg::StateSet& state, const osg::StateSet& other)
{
    if (&state == &other) return true;
    const auto ofMaterial = [](const osg::StateSet& of)
    {
        osg::ref_ptr<osg::StateSet> copy = new osg::StateSet(of, osg::CopyOp::SHALLOW_COPY);
        for (const char* ofMesh : {"POSE_INFLUENCES", "POSE_NO_MORPHS"})
            copy->removeDefine(ofMesh);
        copy->removeUniform("materialName");
        return copy;
    };
    const osg::ref_ptr<osg::StateSet> a = ofMaterial(state), b = ofMaterial(other);
    return a->compare(*b, true) == 0 && a->getDefineList() == b->getDefineList();
}

} // namespace

glm::vec3 unit(const glm::vec3& vector, const glm::vec3& otherwise)
{
    const float length = glm::length(vector);
    return length > 0.0f && std::isfinite(length) ? vector / length : otherwise;
}

bool MergedParts::accepts(const SkinnedGeometry& part)
{
    if (part.getNodeMask() == 0 || part.getDrawCallback() || part.getCullCallback()) return false;
    if (!part.getMorphTargets().empty() || part.getVertexCount() == 0 || part.getNumPrimitiveSets() == 0) return false;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : part.getPrimitiveSetList())
        if (LodLevels::trianglesOf(primitives, part.getVertexCount()).empty()) return false;
    return SurfaceColor::of(part).has_value();
}

bool MergedParts::areAlike(const SkinnedGeometry& part, const SkinnedGeometry& other)
{
    return part.getNodeMask() == other.getNodeMask() &&
           osgGpuAnimation::areAlike(*part.getStateSet(), *other.getStateSet());
}

MergedParts::MergedParts(Parts parts, const Palettes& palettes, std::size_t keyPoseCount, const std::atomic<bool>* stop,
                         bool keepsParts)
    : _parts(std::move(parts)), _palettes(palettes)
{
    _surface.keyPoses = keyPoseCount;
    _surface.stop = stop;
    _surface.isTwoSided = _parts.front().color.isTwoSided();
    addSurface(keepsParts);
    for (std::size_t part = 0; part < _parts.size(); ++part)
        for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : _parts[part].mesh->getPrimitiveSetList())
            for (const std::uint32_t vertex : LodLevels::trianglesOf(primitives, _parts[part].mesh->getVertexCount()))
                _indices.push_back(_firstOf[part] + vertex);
    if (_surface.vertexCount() > maxVertices || _indices.size() > 3 * maxTriangles || _surface.isStopped()) return;
    for (const std::vector<glm::vec3>& pose : _surface.poses)
        if (!std::all_of(pose.begin(), pose.end(), isPlaced)) return;
    for (std::uint32_t vertex = 0; vertex < _surface.vertexCount(); ++vertex)
    {
        const osg::Vec4 color = stored(colorOf(vertex));
        _surface.colors.emplace_back(color.r(), color.g(), color.b());
    }
    _isValid = size() > 0.0;
}

void MergedParts::addSurface(bool keepsParts)
{
    std::vector<glm::dvec3> ofPart;
    for (const std::vector<AffineMatrix>& palette : _palettes)
    {
        std::vector<glm::vec3>& pose = _surface.poses.emplace_back();
        for (const auto& [part, color] : _parts)
        {
            if (_surface.poses.size() == 1) _firstOf.push_back(static_cast<std::uint32_t>(pose.size()));
            part->computePositions(palette, ofPart);
            ofPart.resize(part->getVertexCount(), glm::dvec3(0.0)); // none if the vertices are no osg::Vec3Array
            pose.insert(pose.end(), ofPart.begin(), ofPart.end());
            if (keepsParts && _surface.poses.size() == 1) _surface.pieces.resize(pose.size(), _firstOf.back());
        }
        if (pose.size() > maxVertices || _surface.isStopped()) return;
    }
}

MergedParts::Source MergedParts::sourceOf(std::uint32_t vertex) const
{
    const auto next = std::upper_bound(_firstOf.begin(), _firstOf.end(), vertex);
    const auto part = static_cast<std::size_t>(next - _firstOf.begin() - 1);
    return {part, vertex - _firstOf[part]};
}

SurfaceColor::Look MergedParts::lookAt(const std::uint32_t* triangle, const glm::vec3& shares) const
{
    const std::size_t part = sourceOf(triangle[0]).part;
    const std::uint32_t first = _firstOf[part];
    return _parts[part].color.at({triangle[0] - first, triangle[1] - first, triangle[2] - first}, shares);
}

osg::Vec4 MergedParts::colorOf(std::uint32_t vertex) const
{
    const std::uint32_t corners[3] = {vertex, vertex, vertex};
    return lookAt(corners, glm::vec3(1.0f, 0.0f, 0.0f)).color;
}

std::vector<glm::vec3> MergedParts::normalsIn(std::size_t pose) const
{
    std::vector<glm::vec3> normals;
    std::vector<glm::dvec3> ofPart;
    for (const auto& [part, color] : _parts)
    {
        part->computeNormals(_palettes[pose], ofPart);
        ofPart.resize(part->getVertexCount(), glm::dvec3(0.0));
        for (const glm::dvec3& normal : ofPart)
            normals.push_back(unit(glm::vec3(normal), glm::vec3(0.0f)));
    }
    return normals;
}

/// Of a vertex in a pose.
glm::dmat4 MergedParts::matrixOf(std::uint32_t vertex, const std::vector<AffineMatrix>& palette) const
{
    const Source source = sourceOf(vertex);
    glm::dmat4 sum(0.0);
    _parts[source.part].mesh->forEachInfluence(source.vertex,
                                               [&](std::size_t entry, float weight)
                                               {
                                                   if (entry < palette.size())
                                                       sum += static_cast<double>(weight) * palette[entry].toColumns();
                                               });
    sum[3][3] = 1.0;
    return sum;
}

/// In the parts' own space. A vertex whose first pose has no volume stays at its source.
std::vector<glm::dvec3> MergedParts::bindPositionsOf(const CoarseMesh& mesh) const
{
    std::vector<glm::dvec3> bind;
    for (std::size_t vertex = 0; vertex < mesh.sources.size(); ++vertex)
    {
        const Source source = sourceOf(mesh.sources[vertex]);
        const glm::dmat4 matrix = matrixOf(mesh.sources[vertex], _palettes.front());
        bind.emplace_back(glm::inverse(matrix) * glm::dvec4(mesh.positions[vertex], 1.0));
        if (isPlaced(glm::vec3(bind.back()))) continue;
        const osg::Vec3& there =
            static_cast<const osg::Vec3Array&>(*_parts[source.part].mesh->getVertexArray())[source.vertex];
        bind.back() = glm::dvec3(there.x(), there.y(), there.z());
    }
    return bind;
}

PosedSurface::Poses MergedParts::posesOf(const CoarseMesh& mesh, std::size_t poseCount) const
{
    const std::vector<glm::dvec3> bind = bindPositionsOf(mesh);
    PosedSurface::Poses poses(std::min(poseCount, _palettes.size()));
    for (std::size_t pose = 0; pose < poses.size(); ++pose)
        for (std::size_t vertex = 0; vertex < bind.size(); ++vertex)
            poses[pose].emplace_back(matrixOf(mesh.sources[vertex], _palettes[pose]) * glm::dvec4(bind[vertex], 1.0));
    return poses;
}

glm::mat3 MergedParts::toFirstPose(std::uint32_t vertex, std::size_t pose) const
{
    const glm::mat3 turn(glm::dmat3(matrixOf(vertex, _palettes.front())) *
                         glm::inverse(glm::dmat3(matrixOf(vertex, _palettes[pose]))));
    const glm::vec3 sum = turn[0] + turn[1] + turn[2];
    return isPlaced(sum) ? turn : glm::mat3(0.0f);
}

/// The mesh with a vertex for each part that has a triangle there. A triangle between two parts belongs to the part of
/// most of its vertices. outParts: by vertex.
CoarseMesh MergedParts::splitByParts(const CoarseMesh& mesh, osg::FloatArray& outParts) const
{
    CoarseMesh split;
    std::map<std::pair<std::uint32_t, std::size_t>, std::uint32_t> known; ///< by vertex and part
    for (std::size_t triangle = 0; triangle + 2 < mesh.indices.size(); triangle += 3)
    {
        const std::uint32_t* corners = &mesh.indices[triangle];
        const auto partOf = [&](int corner) { return sourceOf(mesh.sources[corners[corner]]).part; };
        const std::size_t part = partOf(1) == partOf(2) ? partOf(1) : partOf(0);
        for (int corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t vertex = corners[corner];
            const auto [place, isNew] =
                known.emplace(std::pair(vertex, part), static_cast<std::uint32_t>(split.sources.size()));
            split.indices.push_back(place->second);
            if (!isNew) continue;
            split.sources.push_back(mesh.sources[vertex]);
            split.positions.push_back(mesh.positions[vertex]);
            split.colors.push_back(mesh.colors[vertex]);
            outParts.push_back(static_cast<float>(part));
        }
    }
    return split;
}

osg::ref_ptr<SkinnedGeometry> MergedParts::geometryOf(const CoarseMesh& merged) const
{
    osg::ref_ptr<osg::FloatArray> parts = new osg::FloatArray;
    const CoarseMesh mesh = splitByParts(merged, *parts);
    osg::ref_ptr<osg::Vec3Array> bindPositions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (const glm::dvec3& position : bindPositionsOf(mesh))
        bindPositions->push_back(osg::Vec3d(position.x, position.y, position.z));
    for (const osg::Vec4& color : mesh.colors)
        colors->push_back(stored(color));
    osg::ref_ptr<SkinnedGeometry> geometry = new SkinnedGeometry;
    geometry->setVertexArray(bindPositions);
    geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    setInfluences(mesh, *geometry);
    geometry->setVertexAttribArray(POSE_PART_LOCATION, parts, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::DrawElementsUShort> elements = new osg::DrawElementsUShort(GL_TRIANGLES);
    elements->assign(mesh.indices.begin(), mesh.indices.end());
    geometry->addPrimitiveSet(elements);
    osgUtil::VertexCacheVisitor().optimizeVertices(*geometry); // a card shades each vertex 0.74 times, before: once
    osg::BoundingBox bounds;
    for (const auto& [part, color] : _parts)
        bounds.expandBy(part->getBoundingBox());
    geometry->setInitialBound(bounds);
    geometry->setNodeMask(_parts.front().mesh->getNodeMask());
    return geometry;
}

void MergedParts::setInfluences(const CoarseMesh& mesh, SkinnedGeometry& geometry) const
{
    osg::ref_ptr<osg::Vec4usArray> entries[SkinnedGeometry::maxInfluenceSets];
    osg::ref_ptr<osg::Vec4Array> weights[SkinnedGeometry::maxInfluenceSets];
    const auto count = static_cast<unsigned int>(mesh.sources.size());
    std::size_t max = 0;
    for (unsigned int i = 0; i < SkinnedGeometry::maxInfluenceSets; ++i)
    {
        entries[i] = new osg::Vec4usArray(count);
        weights[i] = new osg::Vec4Array(count);
    }
    for (unsigned int vertex = 0; vertex < count; ++vertex)
    {
        const Source source = sourceOf(mesh.sources[vertex]);
        std::size_t number = 0;
        _parts[source.part].mesh->forEachInfluence(source.vertex,
                                                   [&](std::size_t entry, float weight)
                                                   {
                                                       const auto place = static_cast<int>(number % 4);
                                                       (*entries[number / 4])[vertex][place] =
                                                           static_cast<GLushort>(entry);
                                                       (*weights[number / 4])[vertex][place] = weight;
                                                       ++number;
                                                   });
        max = std::max(max, number);
    }
    for (unsigned int i = 0; 4 * i < max; ++i)
        geometry.setInfluences(i, entries[i], weights[i]);
}

} // namespace osgGpuAnimation
