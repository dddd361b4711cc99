// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/lod/MergedMesh.h>

#include <osgGpuAnimation/animation/math/Box.h>
#include <osgGpuAnimation/nodes/lod/LodLevels.h>
#include <osgGpuAnimation/nodes/mesh/PaletteEntryBounds.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace osgGpuAnimation
{

namespace
{

constexpr double reductionShare = 0.8; ///< of a level's error; the rest is for the outset
constexpr int searchSteps = 5;         ///< for the outset
constexpr int fittingSteps = 8;        ///< for the colours
constexpr double fewSeen = 0.1;        ///< of the cells that show a triangle: a side with no more is not visible
constexpr float farthest = 1e18f;      ///< squares of larger coordinates are not finite

bool isPlaced(const glm::vec3& position)
{
    return std::abs(position.x) < farthest && std::abs(position.y) < farthest && std::abs(position.z) < farthest;
}

/// True if the StateSets differ in what depends on the mesh at most.
bool areAlike(const osg::StateSet& state, const osg::StateSet& other)
{
    if (&state == &other) return true;
    const auto ofMaterial = [](const osg::StateSet& of)
    {
        osg::ref_ptr<osg::StateSet> copy = new osg::StateSet(of, osg::CopyOp::SHALLOW_COPY);
        for (const char* ofMesh : {"POSE_INFLUENCES", "POSE_NO_MORPHS"})
            copy->removeDefine(ofMesh);
        return copy;
    };
    const osg::ref_ptr<osg::StateSet> a = ofMaterial(state), b = ofMaterial(other);
    return a->compare(*b, true) == 0 && a->getDefineList() == b->getDefineList();
}

glm::vec3 normalOf(const std::vector<glm::vec3>& positions, const std::uint32_t* triangle)
{
    return glm::cross(positions[triangle[1]] - positions[triangle[0]], positions[triangle[2]] - positions[triangle[0]]);
}

glm::vec3 unit(const glm::vec3& vector, const glm::vec3& otherwise)
{
    const float length = glm::length(vector);
    return length > 0.0f && std::isfinite(length) ? vector / length : otherwise;
}

/// In [0, 1], of a white surface with a light at the viewer and a little everywhere.
float brightness(const glm::vec3& normal, const glm::vec3& towardsViewer)
{
    constexpr float everywhere = 0.2f;
    return everywhere + (1.0f - everywhere) * std::max(glm::dot(normal, towardsViewer), 0.0f);
}

float shadeOf(const osg::Vec4& color)
{
    return (color.r() + color.g() + color.b()) / 3.0f;
}

/// The means of a view's cells in square pixels. cells: across a pixel.
std::vector<double> pixelsOf(const std::vector<float>& view, double cells)
{
    const auto across = static_cast<std::size_t>(std::ceil(SurfaceViews::cellsAcross / std::max(cells, 1.0)));
    std::vector<double> pixels(across * across);
    for (std::size_t cell = 0; cell < view.size(); ++cell)
    {
        const std::size_t x = cell % SurfaceViews::cellsAcross, y = cell / SurfaceViews::cellsAcross;
        const auto pixelAt = [&](std::size_t place)
        { return std::min(static_cast<std::size_t>(static_cast<double>(place) / std::max(cells, 1.0)), across - 1); };
        pixels[pixelAt(y) * across + pixelAt(x)] += view[cell] / (cells * cells);
    }
    return pixels;
}

double structuralSimilarity(const std::vector<double>& a, const std::vector<double>& b)
{
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const auto count = static_cast<double>(a.size());
    const double meanA = std::accumulate(a.begin(), a.end(), 0.0) / count;
    const double meanB = std::accumulate(b.begin(), b.end(), 0.0) / count;
    const double squaresA = std::inner_product(a.begin(), a.end(), a.begin(), 0.0) / count;
    const double squaresB = std::inner_product(b.begin(), b.end(), b.begin(), 0.0) / count;
    const double products = std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / count;
    const double variances = squaresA - meanA * meanA + squaresB - meanB * meanB;
    return (2.0 * meanA * meanB + c1) * (2.0 * (products - meanA * meanB) + c2) /
           ((meanA * meanA + meanB * meanB + c1) * (variances + c2));
}

} // namespace

bool MergedMesh::accepts(const SkinnedGeometry& part)
{
    if (part.getNodeMask() == 0 || part.getDrawCallback() || part.getCullCallback()) return false;
    if (!part.getMorphTargets().empty() || part.getVertexCount() == 0 || part.getNumPrimitiveSets() == 0) return false;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : part.getPrimitiveSetList())
        if (LodLevels::trianglesOf(*primitives, part.getVertexCount()).empty()) return false;
    return SurfaceColor::of(part).has_value();
}

bool MergedMesh::areAlike(const SkinnedGeometry& part, const SkinnedGeometry& other)
{
    return part.getNodeMask() == other.getNodeMask() &&
           osgGpuAnimation::areAlike(*part.getStateSet(), *other.getStateSet());
}

MergedMesh::MergedMesh(const Parts& parts, const Palettes& palettes) : _parts(parts), _palettes(palettes)
{
    for (const SkinnedGeometry* part : _parts)
        _colors.push_back(*SurfaceColor::of(*part));
    addSurface();
    if (_surface.vertexCount() > maxVertices) return;
    Box box;
    for (const std::vector<glm::vec3>& pose : _surface.poses)
        if (!std::all_of(pose.begin(), pose.end(), isPlaced)) return;
    for (const glm::vec3& position : _surface.poses.front())
        box.add(position);
    _size = glm::distance(glm::dvec3(box.min), glm::dvec3(box.max));
    addTriangles();
    if (!(_size > 0.0) || _indices.size() > 3 * maxTriangles) return;
    look();
    for (std::uint32_t vertex = 0; vertex < _surface.vertexCount(); ++vertex)
    {
        const std::uint32_t corners[3] = {vertex, vertex, vertex};
        const osg::Vec4 color = _colors.front().stored(surfaceAt(corners, glm::vec3(1.0f, 0.0f, 0.0f)).color);
        _surface.colors.emplace_back(color.r(), color.g(), color.b());
    }
    _simplifier.emplace(_surface, _indices);
}

void MergedMesh::addSurface()
{
    std::vector<glm::dvec3> positions;
    for (const std::vector<AffineMatrix>& palette : _palettes)
    {
        std::vector<glm::vec3>& pose = _surface.poses.emplace_back();
        for (const SkinnedGeometry* part : _parts)
        {
            if (_surface.poses.size() == 1) _firstOf.push_back(static_cast<std::uint32_t>(pose.size()));
            part->computePositions(palette, positions);
            positions.resize(part->getVertexCount(), glm::dvec3(0.0)); // none if the vertices are no osg::Vec3Array
            pose.insert(pose.end(), positions.begin(), positions.end());
        }
    }
    for (const SkinnedGeometry* part : _parts)
    {
        part->computeNormals(_palettes.front(), positions);
        positions.resize(part->getVertexCount(), glm::dvec3(0.0));
        for (const glm::dvec3& normal : positions)
            _normals.push_back(unit(glm::vec3(normal), glm::vec3(0.0f)));
    }
    const osg::StateSet& state = *_parts.front()->getStateSet();
    _surface.isTwoSided = !(state.getMode(GL_CULL_FACE) & osg::StateAttribute::ON);
}

void MergedMesh::addTriangles()
{
    for (std::size_t part = 0; part < _parts.size(); ++part)
        for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : _parts[part]->getPrimitiveSetList())
            for (const std::uint32_t vertex : LodLevels::trianglesOf(*primitives, _parts[part]->getVertexCount()))
                _indices.push_back(_firstOf[part] + vertex);
}

MergedMesh::Source MergedMesh::sourceOf(std::uint32_t vertex) const
{
    const auto next = std::upper_bound(_firstOf.begin(), _firstOf.end(), vertex);
    const auto part = static_cast<std::size_t>(next - _firstOf.begin() - 1);
    return {part, vertex - _firstOf[part]};
}

/// triangle: three vertices of one part.
SurfaceColor::Look MergedMesh::surfaceAt(const std::uint32_t* triangle, const glm::vec3& barycentric) const
{
    const std::size_t part = sourceOf(triangle[0]).part;
    const std::uint32_t first = _firstOf[part];
    return _colors[part].at({triangle[0] - first, triangle[1] - first, triangle[2] - first}, barycentric);
}

MergedMesh::Look MergedMesh::lookAt(const SurfaceViews::Seen& seen) const
{
    const std::uint32_t* triangle = &_indices[3 * seen.triangle];
    Look look{true, surfaceAt(triangle, seen.barycentric)};
    for (int corner = 0; corner < 3; ++corner)
        look.normal += seen.barycentric[corner] * _normals[triangle[corner]];
    look.normal = unit(look.normal, unit(normalOf(_surface.poses.front(), triangle), glm::vec3(0.0f)));
    if (!seen.isFront) look.normal = -look.normal;
    return look;
}

/// Takes the views of the parts in the rest pose.
void MergedMesh::look()
{
    _views.emplace(_surface.poses.front());
    osg::Vec2 sum;
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        std::vector<Look>& looks = _looks.emplace_back();
        for (const SurfaceViews::Seen& seen :
             _views->seen(view, {_surface.poses.front(), _indices, _surface.isTwoSided}))
        {
            looks.push_back(seen.triangle == SurfaceViews::Seen::none ? Look() : lookAt(seen));
            if (!looks.back().isVisible) continue;
            ++_coveredCells;
            sum += looks.back().surface.metallicRoughness;
        }
        std::vector<float>& shades = _shades.emplace_back();
        for (const Look& look : looks)
            shades.push_back(look.isVisible ? shadeOf(_colors.front().stored(look.surface.color) *
                                                      brightness(look.normal, _views->towards(view)))
                                            : 0.0f);
    }
    if (_coveredCells > 0) _metallicRoughness = sum / static_cast<float>(_coveredCells);
}

void MergedMesh::reduce(double error)
{
    _simplifier->reduce(reductionShare * error, false, true);
}

MergedMesh::Made MergedMesh::make(double error)
{
    const double found = _simplifier->error();
    Coarse made = coarse();
    if (!(found <= error) || made.indices.empty()) return {};
    fitColors(made);
    const std::vector<glm::vec3> moves = outsets(made, error - found);
    for (std::size_t vertex = 0; vertex < moves.size(); ++vertex)
        made.positions[vertex] += moves[vertex];
    shade(made);
    const std::vector<glm::dvec3> offsets = bindOffsets(made, moves);
    return {meshOf(made, offsets), found + farthestMove(made, offsets)};
}

/// The remaining triangles, by vertex of the parts, as a surface of one side: of two-sided parts, those that are
/// visible from behind are turned or doubled, so that the driver can cull the others.
std::vector<std::uint32_t> MergedMesh::oneSided() const
{
    const std::vector<std::uint32_t> corners = _simplifier->indices();
    if (!_surface.isTwoSided) return corners;
    std::vector<std::size_t> fronts(corners.size() / 3), backs(corners.size() / 3);
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        for (const SurfaceViews::Seen& seen : _views->seen(view, {_surface.poses.front(), corners, true}))
            if (seen.triangle != SurfaceViews::Seen::none) ++(seen.isFront ? fronts : backs)[seen.triangle];
    std::vector<std::uint32_t> sided;
    for (std::size_t triangle = 0; triangle < fronts.size(); ++triangle)
    {
        const auto few = static_cast<std::size_t>(fewSeen * static_cast<double>(fronts[triangle] + backs[triangle]));
        const auto first = corners.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
        if (fronts[triangle] > few || backs[triangle] <= few) sided.insert(sided.end(), first, first + 3);
        if (backs[triangle] > few) sided.insert(sided.end(), {first[0], first[2], first[1]});
    }
    return sided;
}

MergedMesh::Coarse MergedMesh::coarse() const
{
    const MeshConnectivity& reduced = _simplifier->mesh();
    const std::vector<glm::vec3>& positions = _surface.poses.front();
    Coarse coarse;
    std::map<std::uint32_t, std::uint32_t> vertexOf; // by point
    const std::vector<std::uint32_t> corners = oneSided();
    for (std::size_t corner = 0; corner < corners.size(); ++corner)
    {
        const auto next = static_cast<std::uint32_t>(coarse.points.size());
        const std::uint32_t point = reduced.pointOf(corners[corner]);
        const auto [known, isNew] = vertexOf.emplace(point, next);
        if (isNew)
        {
            coarse.points.push_back(reduced.verticesOf(point).front());
            coarse.positions.push_back(positions[coarse.points.back()]);
            coarse.normals.emplace_back(0.0f);
        }
        coarse.indices.push_back(known->second);
        coarse.normals[known->second] += normalOf(positions, &corners[corner - corner % 3]);
    }
    for (glm::vec3& normal : coarse.normals)
        normal = unit(normal, glm::vec3(0.0f));
    return coarse;
}

/// function(view, seen, look), for each cell of the views that shows both the mesh and the parts.
template <typename Function>
void MergedMesh::forEachSeen(const Coarse& coarse, Function function) const
{
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        const std::vector<SurfaceViews::Seen> cells = _views->seen(view, {coarse.positions, coarse.indices, false});
        for (std::size_t cell = 0; cell < cells.size(); ++cell)
            if (cells[cell].triangle != SurfaceViews::Seen::none && _looks[view][cell].isVisible)
                function(view, cells[cell], _looks[view][cell]);
    }
}

/// Takes the colours that differ least from the parts in the views when they are interpolated and lit from there: flat
/// triangles are brighter than what they replace.
void MergedMesh::fitColors(Coarse& coarse) const
{
    struct Target
    {
        const std::uint32_t* triangle;
        glm::vec3 barycentric;
        float light;     ///< of the mesh
        osg::Vec4 shown; ///< by the parts
    };
    std::vector<Target> targets;
    forEachSeen(coarse,
                [&](std::size_t view, const SurfaceViews::Seen& seen, const Look& look)
                {
                    const std::uint32_t* triangle = &coarse.indices[3 * seen.triangle];
                    const glm::vec3 normal = unit(normalOf(coarse.positions, triangle), _views->towards(view));
                    targets.push_back({triangle, seen.barycentric, brightness(normal, _views->towards(view)),
                                       look.surface.color * brightness(look.normal, _views->towards(view))});
                });
    std::vector<osg::Vec4> colors;
    for (const std::uint32_t point : coarse.points)
    {
        const std::uint32_t corners[3] = {point, point, point};
        colors.push_back(surfaceAt(corners, glm::vec3(1.0f, 0.0f, 0.0f)).color);
    }
    for (int step = 0; step < fittingSteps; ++step)
    {
        std::vector<osg::Vec4> sums(colors.size());
        std::vector<float> weights(colors.size());
        for (const Target& target : targets)
        {
            osg::Vec4 missing = target.shown;
            for (int corner = 0; corner < 3; ++corner)
                missing -= colors[target.triangle[corner]] * (target.light * target.barycentric[corner]);
            for (int corner = 0; corner < 3; ++corner)
            {
                sums[target.triangle[corner]] += missing * target.barycentric[corner];
                weights[target.triangle[corner]] += target.light * target.barycentric[corner];
            }
        }
        for (std::size_t vertex = 0; vertex < colors.size(); ++vertex)
            if (weights[vertex] > 0.0f) colors[vertex] += sums[vertex] / weights[vertex];
    }
    for (osg::Vec4& color : colors)
    {
        for (int component = 0; component < 3; ++component)
            color[component] = std::clamp(color[component], 0.0f, 1.0f);
        color.a() = 1.0f;
        coarse.colors.push_back(_colors.front().stored(color));
    }
}

/// Takes the views of a mesh for similarity().
void MergedMesh::shade(const Coarse& coarse)
{
    _madeShades.assign(SurfaceViews::viewCount, {});
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        for (const SurfaceViews::Seen& seen : _views->seen(view, {coarse.positions, coarse.indices, false}))
        {
            float shade = 0.0f;
            if (seen.triangle != SurfaceViews::Seen::none)
            {
                const std::uint32_t* triangle = &coarse.indices[3 * seen.triangle];
                osg::Vec4 color;
                for (int corner = 0; corner < 3; ++corner)
                    color += coarse.colors[triangle[corner]] * seen.barycentric[corner];
                const glm::vec3 normal = unit(normalOf(coarse.positions, triangle), _views->towards(view));
                shade = shadeOf(color * brightness(normal, _views->towards(view)));
            }
            _madeShades[view].push_back(shade);
        }
}

double MergedMesh::similarity(double pixel) const
{
    double sum = 0.0;
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        const double cells = pixel / _views->cellSize(view);
        sum += structuralSimilarity(pixelsOf(_shades[view], cells), pixelsOf(_madeShades[view], cells));
    }
    return sum / SurfaceViews::viewCount;
}

/// For each vertex, the mean direction from its neighbours, of length 1 at most: a tip or the edge of a sheet points
/// outwards.
std::vector<glm::vec3> MergedMesh::fromNeighbours(const Coarse& coarse) const
{
    std::vector<glm::vec3> sums(coarse.points.size(), glm::vec3(0.0f));
    std::vector<float> counts(coarse.points.size());
    for (std::size_t corner = 0; corner < coarse.indices.size(); ++corner)
        for (std::size_t other = corner - corner % 3; other < corner - corner % 3 + 3; ++other)
        {
            const std::uint32_t vertex = coarse.indices[corner];
            const glm::vec3 way = coarse.positions[vertex] - coarse.positions[coarse.indices[other]];
            sums[vertex] += unit(way, glm::vec3(0.0f));
            counts[vertex] += other == corner ? 0.0f : 1.0f;
        }
    for (std::size_t vertex = 0; vertex < sums.size(); ++vertex)
        sums[vertex] /= counts[vertex];
    return sums;
}

/// The cells that the mesh covers with its vertices moved by that share of the outsets.
std::size_t MergedMesh::covered(const Coarse& coarse, const std::vector<glm::vec3>& outsets, float share) const
{
    std::vector<glm::vec3> positions = coarse.positions;
    for (std::size_t vertex = 0; vertex < positions.size(); ++vertex)
        positions[vertex] += share * outsets[vertex];
    return _views->coveredCells({positions, coarse.indices, false});
}

/// How the vertices move in the rest pose, by at most that length, for the mesh to cover the views as the parts do.
std::vector<glm::vec3> MergedMesh::outsets(const Coarse& coarse, double most) const
{
    // Closed pieces grow along their normals, sheets along their edges.
    std::vector<glm::vec3> alongEdges = fromNeighbours(coarse), alongNormals = coarse.normals, alongBoth = alongEdges;
    for (std::size_t vertex = 0; vertex < alongBoth.size(); ++vertex)
    {
        alongBoth[vertex] += alongNormals[vertex];
        alongBoth[vertex] /= std::max(1.0f, glm::length(alongBoth[vertex]));
    }
    const std::size_t unmoved = covered(coarse, alongNormals, 0.0f);
    const float farthest = static_cast<float>(unmoved < _coveredCells ? most : -most);
    const auto missing = [&](std::size_t cells)
    { return cells > _coveredCells ? cells - _coveredCells : _coveredCells - cells; };
    std::vector<glm::vec3>* best = nullptr;
    float share = 0.0f;
    std::size_t least = missing(unmoved);
    for (std::vector<glm::vec3>* directions : {&alongNormals, &alongBoth, &alongEdges})
    {
        for (glm::vec3& direction : *directions)
            direction *= farthest;
        float low = 0.0f, high = 1.0f, middle = 1.0f;
        for (int step = 0; step < searchSteps; ++step)
        {
            const std::size_t cells = covered(coarse, *directions, middle);
            if (missing(cells) < least)
            {
                least = missing(cells);
                best = directions;
                share = middle;
            }
            // Growing until enough is covered, or shrinking until no more than that is.
            ((cells < _coveredCells) == (unmoved < _coveredCells) ? low : high) = middle;
            middle = 0.5f * (low + high);
        }
    }
    if (!best) return std::vector<glm::vec3>(coarse.points.size());
    for (glm::vec3& outset : *best)
        outset *= share;
    return *best;
}

/// The matrix of a vertex in a pose, without the translation.
glm::dmat3 MergedMesh::matrixOf(std::uint32_t vertex, const std::vector<AffineMatrix>& palette) const
{
    const Source source = sourceOf(vertex);
    glm::dmat4 sum(0.0);
    _parts[source.part]->forEachInfluence(source.vertex,
                                          [&](std::size_t entry, float weight)
                                          {
                                              if (entry < palette.size())
                                                  sum += static_cast<double>(weight) * palette[entry].toColumns();
                                          });
    return glm::dmat3(sum);
}

/// In the parts' own space. Vertices whose rest pose has no volume do not move.
std::vector<glm::dvec3> MergedMesh::bindOffsets(const Coarse& coarse, const std::vector<glm::vec3>& outsets) const
{
    std::vector<glm::dvec3> offsets;
    for (std::size_t vertex = 0; vertex < coarse.points.size(); ++vertex)
    {
        const glm::dmat3 matrix = matrixOf(coarse.points[vertex], _palettes.front());
        const glm::dvec3 offset = glm::inverse(matrix) * glm::dvec3(outsets[vertex]);
        offsets.push_back(isPlaced(glm::vec3(offset)) ? offset : glm::dvec3(0.0));
    }
    return offsets;
}

/// In all poses.
double MergedMesh::farthestMove(const Coarse& coarse, const std::vector<glm::dvec3>& bindOffsets) const
{
    double most = 0.0;
    for (const std::vector<AffineMatrix>& palette : _palettes)
        for (std::size_t vertex = 0; vertex < coarse.points.size(); ++vertex)
            most = std::max(most, glm::length(matrixOf(coarse.points[vertex], palette) * bindOffsets[vertex]));
    return most;
}

osg::ref_ptr<SkinnedGeometry> MergedMesh::meshOf(const Coarse& coarse, const std::vector<glm::dvec3>& bindOffsets) const
{
    const std::size_t count = coarse.points.size();
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(coarse.colors.begin(), coarse.colors.end());
    for (std::size_t vertex = 0; vertex < count; ++vertex)
    {
        const Source source = sourceOf(coarse.points[vertex]);
        const osg::Vec3& bind =
            static_cast<const osg::Vec3Array&>(*_parts[source.part]->getVertexArray())[source.vertex];
        const glm::dvec3& offset = bindOffsets[vertex];
        positions->push_back(osg::Vec3d(bind) + osg::Vec3d(offset.x, offset.y, offset.z));
    }
    osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    mesh->setVertexArray(positions);
    mesh->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    setInfluences(coarse, *mesh);
    osg::ref_ptr<osg::DrawElementsUShort> elements = new osg::DrawElementsUShort(GL_TRIANGLES);
    elements->assign(coarse.indices.begin(), coarse.indices.end());
    mesh->addPrimitiveSet(elements);
    osg::BoundingBox bounds;
    for (const SkinnedGeometry* part : _parts)
        bounds.expandBy(part->getBoundingBox());
    mesh->setInitialBound(bounds);
    mesh->setNodeMask(_parts.front()->getNodeMask());
    mesh->setStateSet(_colors.front().state(mesh->getInfluenceCount(), _metallicRoughness));
    return mesh;
}

void MergedMesh::setInfluences(const Coarse& coarse, SkinnedGeometry& mesh) const
{
    osg::ref_ptr<osg::Vec4usArray> entries[SkinnedGeometry::maxInfluenceSets];
    osg::ref_ptr<osg::Vec4Array> weights[SkinnedGeometry::maxInfluenceSets];
    const auto count = static_cast<unsigned int>(coarse.points.size());
    std::size_t most = 0;
    for (unsigned int i = 0; i < SkinnedGeometry::maxInfluenceSets; ++i)
    {
        entries[i] = new osg::Vec4usArray(count);
        weights[i] = new osg::Vec4Array(count);
    }
    for (unsigned int vertex = 0; vertex < count; ++vertex)
    {
        const Source source = sourceOf(coarse.points[vertex]);
        std::size_t number = 0;
        _parts[source.part]->forEachInfluence(source.vertex,
                                              [&](std::size_t entry, float weight)
                                              {
                                                  const auto place = static_cast<int>(number % 4);
                                                  (*entries[number / 4])[vertex][place] = static_cast<GLushort>(entry);
                                                  (*weights[number / 4])[vertex][place] = weight;
                                                  ++number;
                                              });
        most = std::max(most, number);
    }
    for (unsigned int i = 0; 4 * i < most; ++i)
        mesh.setInfluences(i, entries[i], weights[i]);
}

} // namespace osgGpuAnimation
