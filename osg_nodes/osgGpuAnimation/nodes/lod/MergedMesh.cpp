// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/lod/MergedMesh.h>

#include <osgGpuAnimation/animation/math/Box.h>
#include <osgGpuAnimation/nodes/CharacterProgram.h>
#include <osgGpuAnimation/nodes/lod/LodLevels.h>

#include <layout.glsl>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

constexpr double reductionShare = 0.92; ///< of a level's error; the rest is for the vertices' outward movement
constexpr double finestShare = 1.0 / 256.0, coarsestShare = 0.5; ///< levels as a share of the parts' size
constexpr std::size_t mostAround = 100; ///< triangles at a point: the cost of fans is quadratic
constexpr int mostInfluences = 4;
constexpr std::size_t silhouettePoses = 4;
constexpr int mostSteps = 6;           ///< of the search for the outward movement
constexpr double areaTolerance = 2e-3; ///< of the silhouettes
constexpr const char* influencesDefine = "POSE_INFLUENCES";

osg::ref_ptr<osg::StateSet> copyOf(const osg::StateSet& state)
{
    return new osg::StateSet(state, osg::CopyOp::SHALLOW_COPY);
}

bool areEqual(const osg::StateSet& state, const osg::StateSet& other)
{
    return state.compare(other, true) == 0 && state.getDefineList() == other.getDefineList();
}

/// True if the StateSets differ in the number of influences at most.
bool areAlike(const osg::StateSet* state, const osg::StateSet* other)
{
    if (state == other) return true;
    if (!state || !other) return false;
    const osg::ref_ptr<osg::StateSet> a = copyOf(*state), b = copyOf(*other);
    a->removeDefine(influencesDefine);
    b->removeDefine(influencesDefine);
    return areEqual(*a, *b);
}

/// Apart from positions, normals and influences.
std::vector<const osg::Array*> otherArraysOf(const SkinnedGeometry& mesh)
{
    std::vector<const osg::Array*> arrays{mesh.getColorArray()};
    for (unsigned int unit = 0; unit < mesh.getNumTexCoordArrays(); ++unit)
        arrays.push_back(mesh.getTexCoordArray(unit));
    for (unsigned int location = 0; location < mesh.getNumVertexAttribArrays(); ++location)
        if (location < POSE_ENTRIES_0_LOCATION || location > POSE_WEIGHTS_1_LOCATION)
            arrays.push_back(mesh.getVertexAttribArray(location));
    return arrays;
}

bool isPerVertex(const osg::Array* array)
{
    return array && array->getBinding() == osg::Array::BIND_PER_VERTEX;
}

bool areAlike(const osg::Array* array, const osg::Array* other)
{
    if (!isPerVertex(array) || !isPerVertex(other)) return array == other;
    return array->getType() == other->getType() && array->getNormalize() == other->getNormalize() &&
           array->getPreserveDataType() == other->getPreserveDataType();
}

bool isPlaced(const glm::vec3& position)
{
    constexpr float farthest = 1e18f; // squares of larger coordinates are not finite
    return std::abs(position.x) < farthest && std::abs(position.y) < farthest && std::abs(position.z) < farthest;
}

osg::Vec3 toVec3(const glm::dvec3& value)
{
    return {static_cast<float>(value.x), static_cast<float>(value.y), static_cast<float>(value.z)};
}

glm::dmat4 blended(const SkinnedGeometry& mesh, std::size_t vertex, const std::vector<AffineMatrix>& palette)
{
    glm::dmat4 sum(0.0);
    mesh.forEachInfluence(vertex,
                          [&](std::size_t entry, float weight)
                          {
                              if (entry < palette.size()) sum += double(weight) * palette[entry].toColumns();
                          });
    return sum;
}

/// The strongest influences with weights whose sum is that of all.
std::vector<std::pair<float, std::size_t>> strongest(const SkinnedGeometry& mesh, std::size_t vertex, int count)
{
    std::vector<std::pair<float, std::size_t>> influences;
    float sum = 0.0f, kept = 0.0f;
    mesh.forEachInfluence(vertex,
                          [&](std::size_t entry, float weight)
                          {
                              influences.emplace_back(weight, entry);
                              sum += weight;
                          });
    std::stable_sort(influences.begin(), influences.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    influences.resize(std::min<std::size_t>(influences.size(), static_cast<std::size_t>(count)));
    for (const auto& [weight, entry] : influences)
        kept += weight;
    for (auto& [weight, entry] : influences)
        if (kept > 0.0f) weight *= sum / kept;
    return influences;
}

int mostInfluencesOf(const std::vector<const SkinnedGeometry*>& parts)
{
    int most = 1;
    for (const SkinnedGeometry* part : parts)
        most = std::max(most, part->getInfluenceCount());
    return std::min(most, mostInfluences);
}

} // namespace

MergedLook::MergedLook(const std::vector<const SkinnedGeometry*>& parts)
{
    for (const SkinnedGeometry* part : parts)
    {
        const osg::StateSet* state = part->getStateSet();
        const bool isKnown =
            std::any_of(_known.begin(), _known.end(), [&](const Known& known) { return known.state == state; });
        if (state && !isKnown) _known.push_back({state, copyOf(*state)});
    }
}

bool MergedLook::isPresent() const
{
    return std::all_of(_known.begin(), _known.end(),
                       [](const Known& known) { return areEqual(*known.state, *known.copy); });
}

osg::StateSet* MergedLook::state(int influences)
{
    if (_known.empty()) return nullptr;
    osg::ref_ptr<osg::StateSet>& state = _states[influences - 1];
    if (state) return state;
    state = copyOf(*_known.front().state);
    if (state->getDefinePair(influencesDefine)) applySkinDefines(*state, influences, false);
    return state;
}

bool MergedMesh::accepts(const SkinnedGeometry& part)
{
    if (part.getNodeMask() == 0 || part.getDrawCallback() || !part.getMorphTargets().empty()) return false;
    if (!dynamic_cast<const osg::Vec3Array*>(part.getVertexArray()) || part.getVertexCount() == 0) return false;
    if (part.getSecondaryColorArray() || part.getFogCoordArray() || part.getNumPrimitiveSets() == 0) return false;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : part.getPrimitiveSetList())
        if (trianglesOf(*primitives, part.getVertexCount()).empty()) return false;
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(part.getNormalArray());
    if (part.getNormalArray() && (!normals || !isPerVertex(normals) || normals->size() != part.getVertexCount()))
        return false;
    const std::vector<const osg::Array*> arrays = otherArraysOf(part);
    return std::all_of(arrays.begin(), arrays.end(),
                       [&](const osg::Array* array)
                       { return !isPerVertex(array) || array->getNumElements() == part.getVertexCount(); });
}

bool MergedMesh::areAlike(const SkinnedGeometry& part, const SkinnedGeometry& other)
{
    if (part.getNodeMask() != other.getNodeMask()) return false;
    if (!part.getNormalArray() != !other.getNormalArray()) return false;
    if (!osgGpuAnimation::areAlike(part.getStateSet(), other.getStateSet())) return false;
    const std::vector<const osg::Array*> arrays = otherArraysOf(part), others = otherArraysOf(other);
    return arrays.size() == others.size() &&
           std::equal(arrays.begin(), arrays.end(), others.begin(),
                      [](const osg::Array* a, const osg::Array* b) { return osgGpuAnimation::areAlike(a, b); });
}

MergedMesh::MergedMesh(const Parts& parts, const Palettes& palettes)
    : _parts(parts), _palettes(palettes), _look(std::make_shared<MergedLook>(parts))
{
    addSurface();
    if (_surface.vertexCount() > maxVertices) return;
    for (const std::vector<glm::vec3>& pose : _surface.poses)
        if (!std::all_of(pose.begin(), pose.end(), isPlaced)) return;
    if (isMirrored()) return;
    Box box;
    for (const glm::vec3& position : _surface.poses.front())
        box.add(position);
    const double size = glm::distance(glm::dvec3(box.min), glm::dvec3(box.max));
    if (!(size > 0.0)) return;
    _finest = LodLevels::levelOf(finestShare * size);
    _coarsest = LodLevels::levelOf(coarsestShare * size);
    addTriangles();
    if (_indices.size() > 3 * maxTriangles) return;
    Silhouettes::Poses poses;
    for (std::size_t i = 0; i < silhouettePoses; ++i)
        poses.push_back(_surface.poses[i * _surface.poses.size() / silhouettePoses]);
    _silhouettes.emplace(poses);
    _area = _silhouettes->meanArea(poses, _indices);
    _builder.emplace(_surface, _indices);
    _simplifier.emplace(_surface, _indices);
}

/// True if a vertex is seen in a mirror in the first pose, so that the normals of its triangles point inwards.
bool MergedMesh::isMirrored() const
{
    for (const SkinnedGeometry* part : _parts)
        for (std::size_t vertex = 0; vertex < part->getVertexCount(); ++vertex)
            if (glm::determinant(glm::dmat3(blended(*part, vertex, _palettes.front()))) < 0.0) return true;
    return false;
}

void MergedMesh::addSurface()
{
    std::vector<glm::dvec3> positions;
    for (const std::vector<AffineMatrix>& palette : _palettes)
    {
        std::vector<glm::vec3>& pose = _surface.poses.emplace_back();
        for (const SkinnedGeometry* part : _parts)
        {
            part->computePositions(palette, positions);
            pose.insert(pose.end(), positions.begin(), positions.end());
        }
    }
    for (const SkinnedGeometry* part : _parts)
    {
        part->computeNormals(_palettes.front(), positions);
        for (const glm::dvec3& normal : positions)
        {
            const double length = glm::length(normal);
            _surface.normals.emplace_back(length > 0.0 && std::isfinite(length) ? glm::vec3(normal / length)
                                                                                : glm::vec3(0.0f));
        }
    }
    if (_surface.normals.size() != _surface.vertexCount()) _surface.normals.clear();
    for (const SkinnedGeometry* part : _parts)
    {
        const auto* texCoords =
            part->getNumTexCoordArrays() > 0 ? dynamic_cast<const osg::Vec2Array*>(part->getTexCoordArray(0)) : nullptr;
        if (!isPerVertex(texCoords)) continue;
        for (const osg::Vec2& uv : *texCoords)
            _surface.texCoords.emplace_back(std::isfinite(uv.x()) ? uv.x() : 0.0f,
                                            std::isfinite(uv.y()) ? uv.y() : 0.0f);
    }
    if (_surface.texCoords.size() != _surface.vertexCount()) _surface.texCoords.clear();
}

void MergedMesh::addTriangles()
{
    std::uint32_t first = 0;
    for (const SkinnedGeometry* part : _parts)
    {
        _firstOf.push_back(first);
        for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : part->getPrimitiveSetList())
            for (const std::uint32_t vertex : trianglesOf(*primitives, part->getVertexCount()))
                _indices.push_back(first + vertex);
        first += static_cast<std::uint32_t>(part->getVertexCount());
    }
}

MergedMesh::Source MergedMesh::sourceOf(std::uint32_t vertex) const
{
    const auto next = std::upper_bound(_firstOf.begin(), _firstOf.end(), vertex);
    const auto part = static_cast<std::size_t>(next - _firstOf.begin()) - 1;
    return {_parts[part], vertex - _firstOf[part]};
}

void MergedMesh::reduceTo(int level)
{
    _simplifier->reduce(reductionShare * LodLevels::errorOf(level), false, true);
}

osg::ref_ptr<SkinnedGeometry> MergedMesh::make(int level)
{
    const double limit = LodLevels::errorOf(level);
    const CoarseSurface coarse = _builder->build(_simplifier->mesh());
    if (coarse.indices.empty() || coarse.vertices.size() > 65535) return nullptr;
    const std::vector<glm::dvec3> outwards = offsets(coarse);
    for (int influences = 1, most = mostInfluencesOf(_parts); influences <= most; ++influences)
    {
        osg::ref_ptr<SkinnedGeometry> mesh = makeMesh(coarse, influences);
        auto& positions = static_cast<osg::Vec3Array&>(*mesh->getVertexArray());
        const std::vector<osg::Vec3> stillPositions(positions.begin(), positions.end());
        const std::vector<std::vector<glm::vec3>> still = posed(*mesh);
        for (std::size_t i = 0; i < positions.size(); ++i)
            positions[i] += toVec3(limit * outwards[i]);
        std::vector<std::vector<glm::vec3>> moved = posed(*mesh);
        const double toKeepArea = distanceToKeepArea(coarse, still, moved, 1.0);
        for (const double share : {toKeepArea, 0.75 * toKeepArea, 0.5 * toKeepArea, 0.0})
        {
            for (std::size_t i = 0; i < positions.size(); ++i)
                positions[i] = stillPositions[i] + toVec3(share * limit * outwards[i]);
            if (!isWithin(limit, coarse, posed(*mesh))) continue;
            mesh->setStateSet(_look->state(influences));
            return mesh;
        }
    }
    return nullptr;
}

/// The bind-space vector of each vertex that moves it by 1 along its normal in the first pose.
std::vector<glm::dvec3> MergedMesh::offsets(const CoarseSurface& coarse) const
{
    std::vector<glm::dvec3> offsets;
    for (const CoarseSurface::Vertex& vertex : coarse.vertices)
    {
        const Source source = sourceOf(vertex.place);
        const glm::dmat3 bindToPose(blended(*source.part, source.vertex, _palettes.front()));
        const bool isInvertible = std::abs(glm::determinant(bindToPose)) > 0.0;
        const glm::dvec3 offset =
            isInvertible ? glm::inverse(bindToPose) * glm::dvec3(vertex.outwards) : glm::dvec3(0.0);
        offsets.push_back(isPlaced(glm::vec3(offset)) ? offset : glm::dvec3(0.0));
    }
    return offsets;
}

osg::ref_ptr<SkinnedGeometry> MergedMesh::makeMesh(const CoarseSurface& coarse, int influences)
{
    osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    const SkinnedGeometry& first = *_parts.front();
    mesh->setName(first.getName());
    mesh->setNodeMask(first.getNodeMask());
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray;
    osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array;
    for (const CoarseSurface::Vertex& vertex : coarse.vertices)
    {
        const Source source = sourceOf(vertex.place);
        positions->push_back(static_cast<const osg::Vec3Array&>(*source.part->getVertexArray())[source.vertex]);
        const glm::dmat3 bindToPose(blended(*source.part, source.vertex, _palettes.front()));
        const glm::dvec3 normal = glm::transpose(glm::dmat3(bindToPose)) * glm::dvec3(vertex.normal);
        const double length = glm::length(normal);
        normals->push_back(length > 0.0 ? toVec3(normal / length) : osg::Vec3(0, 0, 1));
        entries->push_back({0, 0, 0, 0});
        weights->push_back({0, 0, 0, 0});
        int i = 0;
        for (const auto& [weight, entry] : strongest(*source.part, source.vertex, influences))
        {
            entries->back()[i] = static_cast<unsigned short>(entry);
            weights->back()[i++] = weight;
        }
    }
    mesh->setVertexArray(positions);
    if (first.getNormalArray()) mesh->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    copyArrays(coarse, *mesh);
    mesh->setInfluences(0, entries, weights);
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    triangles->assign(coarse.indices.begin(), coarse.indices.end());
    mesh->addPrimitiveSet(triangles);
    osg::BoundingBox box;
    for (const SkinnedGeometry* part : _parts)
        box.expandBy(part->getBoundingBox());
    mesh->setInitialBound(box);
    return mesh;
}

/// Those of otherArraysOf().
void MergedMesh::copyArrays(const CoarseSurface& coarse, SkinnedGeometry& mesh) const
{
    const auto copied = [&](const osg::Array* array, auto arrayOf) -> osg::Array*
    {
        if (!isPerVertex(array)) return const_cast<osg::Array*>(array);
        auto* copy = static_cast<osg::Array*>(array->cloneType());
        copy->setBinding(array->getBinding());
        copy->setNormalize(array->getNormalize());
        copy->setPreserveDataType(array->getPreserveDataType());
        copy->resizeArray(static_cast<unsigned int>(coarse.vertices.size()));
        const std::size_t bytes = array->getElementSize();
        auto* to = static_cast<unsigned char*>(const_cast<GLvoid*>(copy->getDataPointer()));
        for (const CoarseSurface::Vertex& vertex : coarse.vertices)
        {
            const Source source = sourceOf(vertex.look);
            const auto* from = static_cast<const unsigned char*>(arrayOf(*source.part)->getDataPointer());
            std::memcpy(to, from + source.vertex * bytes, bytes);
            to += bytes;
        }
        return copy;
    };
    const SkinnedGeometry& first = *_parts.front();
    mesh.setColorArray(copied(first.getColorArray(), [](const SkinnedGeometry& part) { return part.getColorArray(); }));
    for (unsigned int unit = 0; unit < first.getNumTexCoordArrays(); ++unit)
        mesh.setTexCoordArray(unit, copied(first.getTexCoordArray(unit), [unit](const SkinnedGeometry& part)
                                           { return part.getTexCoordArray(unit); }));
    for (unsigned int location = 0; location < first.getNumVertexAttribArrays(); ++location)
        if (location < POSE_ENTRIES_0_LOCATION || location > POSE_WEIGHTS_1_LOCATION)
            mesh.setVertexAttribArray(location, copied(first.getVertexAttribArray(location),
                                                       [location](const SkinnedGeometry& part)
                                                       { return part.getVertexAttribArray(location); }));
}

std::vector<std::vector<glm::vec3>> MergedMesh::posed(const SkinnedGeometry& mesh) const
{
    std::vector<std::vector<glm::vec3>> poses;
    std::vector<glm::dvec3> positions;
    for (const std::vector<AffineMatrix>& palette : _palettes)
    {
        mesh.computePositions(palette, positions);
        poses.emplace_back(positions.begin(), positions.end());
    }
    return poses;
}

/// The share of the way from `still` to `moved`, in [0, most], at which the silhouettes have the area of the parts'.
double MergedMesh::distanceToKeepArea(const CoarseSurface& coarse, const std::vector<std::vector<glm::vec3>>& still,
                                      const std::vector<std::vector<glm::vec3>>& moved, double most) const
{
    const auto areaAt = [&](double share)
    {
        Silhouettes::Poses poses;
        for (std::size_t i = 0; i < silhouettePoses; ++i)
        {
            const std::size_t pose = i * still.size() / silhouettePoses;
            poses.push_back(still[pose]);
            for (std::size_t vertex = 0; vertex < poses.back().size(); ++vertex)
                poses.back()[vertex] += static_cast<float>(share) * (moved[pose][vertex] - still[pose][vertex]);
        }
        return _silhouettes->meanArea(poses, coarse.indices);
    };
    double least = 0.0;
    if (areaAt(least) >= _area) return least;
    for (int step = 0; step < mostSteps; ++step)
    {
        const double middle = 0.5 * (least + most), area = areaAt(middle);
        if (std::abs(area - _area) < areaTolerance * _area) return middle;
        (area < _area ? least : most) = middle;
    }
    return 0.5 * (least + most);
}

/// The triangles at a point and at its neighbours, apart from neighbours with very many.
std::vector<std::uint32_t> MergedMesh::trianglesAround(std::uint32_t point,
                                                       const std::vector<std::vector<std::uint32_t>>& trianglesAt,
                                                       const std::vector<std::uint32_t>& corners) const
{
    std::vector<std::uint32_t> around = trianglesAt[point];
    if (around.size() > mostAround) return around;
    for (const std::uint32_t triangle : trianglesAt[point])
        for (int corner = 0; corner < 3; ++corner)
        {
            const std::vector<std::uint32_t>& there =
                trianglesAt[_simplifier->mesh().pointOf(corners[3 * triangle + corner])];
            if (there.size() <= mostAround) around.insert(around.end(), there.begin(), there.end());
        }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
}

/// True if every original point is, in all poses, that near to the triangles around the point it was collapsed into.
bool MergedMesh::isWithin(double limit, const CoarseSurface& coarse,
                          const std::vector<std::vector<glm::vec3>>& poses) const
{
    const MeshConnectivity& reduced = _simplifier->mesh();
    const std::vector<std::uint32_t> corners = reduced.indices();
    std::vector<std::vector<std::uint32_t>> trianglesAt(reduced.pointCount());
    for (std::size_t i = 0; i < corners.size(); ++i)
        trianglesAt[reduced.pointOf(corners[i])].push_back(static_cast<std::uint32_t>(i / 3));
    for (std::uint32_t kept = 0; kept < reduced.pointCount(); ++kept)
    {
        const std::vector<std::uint32_t> around = trianglesAround(kept, trianglesAt, corners);
        if (around.empty()) continue;
        for (const std::uint32_t point : reduced.collapsedInto(kept))
            for (std::size_t pose = 0; pose < poses.size(); ++pose)
            {
                const auto isNear = [&](std::uint32_t triangle)
                {
                    const auto at = [&](std::size_t corner)
                    { return glm::dvec3(poses[pose][coarse.indices[3 * triangle + corner]]); };
                    return squaredDistanceToTriangle(reduced.at(pose, point), at(0), at(1), at(2)) <= limit * limit;
                };
                if (std::none_of(around.begin(), around.end(), isNear)) return false;
            }
    }
    return true;
}

} // namespace osgGpuAnimation
