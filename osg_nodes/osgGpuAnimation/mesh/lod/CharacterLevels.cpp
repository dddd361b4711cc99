// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/mesh/MeshSimplifier.h>
#include <osgGpuAnimation/mesh/lod/MergedViews.h>

#include <glm/common.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

// As a share of the parts' size: finer levels would show the missing textures; coarser ones are a few pixels large.
constexpr double finestShare = 1.0 / 128.0, coarsestShare = 0.25;
constexpr double worthwhile = 0.9; ///< a level has at most this share of the triangles before
constexpr std::size_t fewestTriangles = 8;
constexpr double coarser = 1.19;               ///< a limit, relative to the one before
constexpr std::size_t posedVertices = 300'000; ///< in all key poses
constexpr std::size_t otherPoses = 256;        ///< beside the key poses
// A mesh is used from the level on at which its picture has that structural similarity, with pixels that are twice the
// level's error: a pixel error of 0.5.
constexpr double minSimilarity = 0.98, usualPixel = 2.0;

/// Of the parts at a level of their own. levels: by mesh.
std::size_t trianglesOf(const MergedParts::Parts& parts, const std::vector<std::size_t>& meshes,
                        const CharacterLevels::Sources::Levels& levels, int level)
{
    std::size_t indices = 0;
    for (std::size_t part = 0; part < parts.size(); ++part)
    {
        const SkinnedGeometry& mesh = *parts[part].mesh;
        for (unsigned int i = 0; i < mesh.getNumPrimitiveSets(); ++i)
        {
            const osg::PrimitiveSet* drawn = levels[meshes[part]]->reduced(i, level).elements;
            if (!drawn) drawn = mesh.getPrimitiveSet(i);
            if (drawn) indices += drawn->getNumIndices();
        }
    }
    return indices / 3;
}

std::size_t trianglesOf(const SkinnedGeometry& merged)
{
    return merged.getPrimitiveSet(0)->getNumIndices() / 3;
}

constexpr double maxForOutlines = 0.3, maxForCoverage = 0.045; ///< moves of vertices, as shares of the limit
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// MergedParts as one mesh with colours in its vertices instead of textures and flat triangles, reduced to coarse
/// levels of detail. The parts' pieces are joined where they are nearer to each other than the error of a level. The
/// vertices are moved and coloured until the mesh looks like the parts, see MergedViews. A temporary object:
///
///     MergedMesh merged(parts);
///     merged.reduce(error);
///     if (merged.fit() <= maxError && merged.similarity(pixel) > 0.98) draw(merged.make());
class MergedMesh
{
public:
    /// parts: valid; they must outlive this object.
    explicit MergedMesh(const MergedParts& parts);

    /// Reduces the triangles as far as an error permits, in the set's units. Call it with ascending errors.
    void reduce(double error);
    std::size_t triangleCount() const { return _simplifier.triangleCount(); } ///< of the remaining triangles
    /// Moves and colours the remaining vertices; there must be some. Returns the largest distance of a vertex of the
    /// parts from the mesh in all poses, in the set's units.
    double fit();
    /// See MergedViews::similarity(); of the last fit().
    double similarity(double pixel) const { return _views.similarity(_shades, pixel); }
    /// The mesh of the last fit(), without a StateSet, see SurfaceColor::flatState().
    osg::ref_ptr<SkinnedGeometry> make() const { return _parts.geometryOf(_mesh); }
    const osg::Vec2& metallicRoughness() const { return _views.metallicRoughness(); } ///< the mean of the visible map

private:
    void takeTriangles();

    const MergedParts& _parts;
    MeshSimplifier _simplifier;
    MergedViews _views;
    double _limit = 0.0;        ///< of the last reduce()
    std::size_t _worstPose = 0; ///< of the last error
    CoarseMesh _mesh;
    MergedViews::Shades _shades;          ///< of _mesh
    std::vector<std::uint32_t> _vertexOf; ///< by point of the simplifier's mesh: in _mesh
};

MergedMesh::MergedMesh(const MergedParts& parts)
    : _parts(parts), _simplifier(parts.surface(), parts.indices()), _views(parts)
{
}

void MergedMesh::reduce(double error)
{
    _limit = error;
    _simplifier.reduce(error, false, true);
}

double MergedMesh::fit()
{
    takeTriangles();
    const std::vector<glm::vec3> unmoved = _mesh.positions;
    _views.fitOutlines(_mesh, maxForOutlines * _limit);
    _views.fitCoverage(_mesh, maxForCoverage * _limit);
    const std::vector<glm::vec3> moved = _mesh.positions;
    // A coarser level would cost more triangles than the moves gain.
    const double enough = LodLevels::errorOf(LodLevels::levelFor(_limit));
    PosedSurface::Poses poses;
    double error = 0.0;
    for (const float share : {1.0f, 0.5f, 0.25f})
    {
        const bool isLast = share == 0.25f;
        for (std::size_t vertex = 0; vertex < moved.size(); ++vertex)
            _mesh.positions[vertex] = glm::mix(unmoved[vertex], moved[vertex], share);
        poses = _parts.posesOf(_mesh);
        error = _simplifier.errorOfMoved(poses, _vertexOf, isLast ? std::numeric_limits<double>::infinity() : enough,
                                         _worstPose);
        if (error <= enough) break;
    }
    _shades = _views.fitColors(_mesh, poses);
    return error;
}

/// Takes the remaining triangles, with one vertex a point.
void MergedMesh::takeTriangles()
{
    const MeshConnectivity& reduced = _simplifier.mesh();
    _mesh = {};
    _vertexOf.assign(reduced.pointCount(), none);
    for (const std::uint32_t corner : _views.oneSided(_simplifier.indices()))
    {
        const std::uint32_t point = reduced.pointOf(corner);
        if (_vertexOf[point] == none)
        {
            _vertexOf[point] = static_cast<std::uint32_t>(_mesh.sources.size());
            _mesh.sources.push_back(reduced.verticesOf(point).front());
            _mesh.positions.push_back(_parts.surface().poses.front()[_mesh.sources.back()]);
        }
        _mesh.indices.push_back(_vertexOf[point]);
    }
}

} // namespace

bool CharacterLevels::isOf(const osg::Group& meshes, const AnimationSet& set) const
{
    bool isSame = &set == _set;
    std::size_t count = 0;
    forEachMesh(meshes,
                [&](const SkinnedGeometry& mesh)
                {
                    isSame = isSame && count < _parts.size() && _parts[count].isOf(mesh);
                    ++count;
                });
    return isSame && count == _parts.size();
}

std::vector<CharacterLevels::Part> CharacterLevels::partsOf(const osg::Group& meshes)
{
    std::vector<Part> parts;
    forEachMesh(meshes, [&](const SkinnedGeometry& mesh) { parts.emplace_back(mesh); });
    return parts;
}

CharacterLevels::Sources::Sources(const std::vector<Mesh>& meshes, bool keepsParts) : _keepsParts(keepsParts)
{
    for (const Mesh& mesh : meshes)
        _vertexCount += mesh.mesh->getVertexCount();
    if (meshes.size() > maxParts || _vertexCount > maxVertices) return;
    for (std::size_t index = 0; index < meshes.size(); ++index)
    {
        const SkinnedGeometry& mesh = *meshes[index].mesh;
        if (!MergedParts::accepts(mesh)) continue;
        const auto alike = std::find_if(_groups.begin(), _groups.end(),
                                        [&](const Group& group)
                                        {
                                            return group.meshes.size() < MergedParts::maxParts &&
                                                   MergedParts::areAlike(*meshes[group.meshes.front()].mesh, mesh);
                                        });
        Group& group = alike == _groups.end() ? _groups.emplace_back() : *alike;
        group.meshes.push_back(index);
        group.parts.push_back({meshes[index].copy, *SurfaceColor::of(*meshes[index].copy, mesh.getStateSet())});
    }
}

std::vector<CharacterLevels::Made> CharacterLevels::Sources::make(const AnimationSet& set, const Levels& levels,
                                                                  const std::atomic<bool>* stop) const
{
    std::vector<Made> made;
    if (set.paletteSize() == 0 || isEmpty()) return made;
    MergedParts::Palettes palettes;
    const MeasuredPoses measured(set, LodLevels::poseCountOf(_vertexCount, posedVertices), otherPoses);
    for (const PoseInstruction& pose : measured.poses)
    {
        if (stop && *stop) return made;
        Pose::evaluate(set, pose, AffineMatrix(), palettes.emplace_back());
    }
    for (const Group& group : _groups)
    {
        const MergedParts parts(group.parts, palettes, measured.keyPoseCount, stop, _keepsParts);
        std::optional<Made> ofGroup = parts.isValid() ? makeGroup(group, parts, levels) : std::nullopt;
        if (ofGroup) made.push_back(std::move(*ofGroup));
    }
    return made;
}

std::optional<CharacterLevels::Made> CharacterLevels::Sources::makeGroup(const Group& group, const MergedParts& parts,
                                                                         const Levels& levels)
{
    MergedMesh mesh(parts);
    Merged merged{group.meshes, {}};
    const double min = finestShare * parts.size(), max = coarsestShare * parts.size();
    const int finest = LodLevels::levelOf(min), coarsest = LodLevels::levelOf(max);
    for (double limit = min; limit <= max; limit *= coarser)
    {
        const std::size_t before = mesh.triangleCount();
        mesh.reduce(limit);
        if (parts.surface().isStopped()) return std::nullopt;
        if (mesh.triangleCount() == 0) break;
        if (mesh.triangleCount() == before) continue;
        const double error = mesh.fit();
        int level = std::max(finest, LodLevels::levelFor(error));
        while (level <= coarsest && mesh.similarity(usualPixel * LodLevels::errorOf(level)) < minSimilarity)
            ++level;
        if (level > coarsest && !merged.steps.empty()) break; // coarser ones are less similar
        if (level > coarsest) continue;
        while (!merged.steps.empty() && merged.steps.back().level >= level)
            merged.steps.pop_back();
        const double enough = merged.steps.empty()
                                  ? static_cast<double>(trianglesOf(group.parts, group.meshes, levels, level))
                                  : worthwhile * static_cast<double>(trianglesOf(*merged.steps.back().mesh));
        if (static_cast<double>(mesh.triangleCount()) <= enough) merged.steps.push_back({level, mesh.make(), error});
        if (mesh.triangleCount() <= fewestTriangles) break;
    }
    if (merged.steps.empty()) return std::nullopt;
    return Made{std::move(merged), mesh.metallicRoughness()};
}

void CharacterLevels::includeMade(std::vector<Made> made)
{
    for (Made& group : made)
    {
        const osg::StateSet& state = *_parts[group.merged.parts.front()].state;
        for (const Step& step : group.merged.steps)
            step.mesh->setStateSet(
                SurfaceColor::flatState(state, step.mesh->getInfluenceCount(), group.metallicRoughness));
        include(std::move(group.merged));
    }
}

void CharacterLevels::include(Merged merged)
{
    const int first = merged.steps.front().level;
    _finest = _finest == LodLevels::allTriangles ? first : std::min(_finest, first);
    _coarsest = std::max(_coarsest, merged.steps.back().level);
    _merged.push_back(std::move(merged));
}

Result<std::shared_ptr<const CharacterLevels>>
CharacterLevels::restored(const osg::Group& meshes, const AnimationSet& set, std::vector<Merged> merged)
{
    const std::shared_ptr<CharacterLevels> levels(new CharacterLevels(partsOf(meshes), set));
    for (std::size_t i = 0; i < merged.size(); ++i)
        if (const Result<void> taken = levels->restore(std::move(merged[i])); !taken)
            return Error{"merged parts " + std::to_string(i) + ": " + taken.error().message};
    return std::shared_ptr<const CharacterLevels>(levels);
}

Result<void> CharacterLevels::restore(Merged merged)
{
    std::size_t first = 0;
    for (const std::size_t part : merged.parts)
    {
        if (part < first || part >= _parts.size())
            return Error{"part " + std::to_string(part) + " of " + std::to_string(_parts.size())};
        if (isMerged(*_parts[part].mesh, std::numeric_limits<int>::max()))
            return Error{"part " + std::to_string(part) + " a second time"};
        first = part + 1;
    }
    if (merged.parts.empty() || merged.steps.empty()) return Error{"no parts or no levels"};
    if (merged.parts.size() > MergedParts::maxParts) return Error{std::to_string(merged.parts.size()) + " parts"};
    int previous = LodLevels::allTriangles;
    for (const Step& step : merged.steps)
    {
        if (!LodLevels::mayFollow(previous, step.level, step.error))
            return Error{"level " + std::to_string(step.level) + " with an error of " + std::to_string(step.error)};
        previous = step.level;
    }
    include(std::move(merged));
    return {};
}

const CharacterLevels::Step* CharacterLevels::Merged::at(int level) const
{
    const Step* found = nullptr;
    for (const Step& step : steps)
        if (step.level <= level) found = &step;
    return found;
}

double CharacterLevels::foundError(int level) const
{
    double error = 0.0;
    for (const Merged& merged : _merged)
        if (const Step* step = merged.at(level)) error = std::max(error, step->error);
    return error;
}

bool CharacterLevels::isMerged(const SkinnedGeometry& part, int level) const
{
    const auto isPart = [&](std::size_t index) { return _parts[index].mesh == &part; };
    return std::any_of(_merged.begin(), _merged.end(),
                       [&](const Merged& merged)
                       { return merged.at(level) && std::any_of(merged.parts.begin(), merged.parts.end(), isPart); });
}

void CharacterLevels::releaseGLObjects(osg::State* state) const
{
    for (const Merged& merged : _merged)
        for (const Step& step : merged.steps)
            step.mesh->releaseGLObjects(state);
}

void CharacterLevels::resizeGLObjectBuffers(unsigned int maxSize) const
{
    for (const Merged& merged : _merged)
        for (const Step& step : merged.steps)
            step.mesh->resizeGLObjectBuffers(maxSize);
}

} // namespace osgGpuAnimation
