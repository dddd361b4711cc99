// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/lod/CharacterLevels.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/lod/MergedMesh.h>

#include <algorithm>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

// As a share of the parts' size: finer levels would show the missing textures; coarser ones are a few pixels large.
constexpr double finestShare = 1.0 / 90.0, coarsestShare = 0.25;
constexpr double worthwhile = 0.9; ///< a level has at most this share of the triangles before
constexpr std::size_t fewestTriangles = 8;
// A mesh is used from the level on at which its picture has that structural similarity, with pixels that are twice the
// level's error: a pixel error of 0.5.
constexpr double leastSimilarity = 0.97, usualPixel = 2.0;

/// Of the parts at a level of their own.
std::size_t trianglesOf(const CharacterLevels::Parts& parts, const AnimationSet& set, int level)
{
    std::size_t indices = 0;
    for (const SkinnedGeometry* part : parts)
    {
        const std::shared_ptr<const LodLevels> levels = part->getLodLevels(set);
        for (unsigned int i = 0; i < part->getNumPrimitiveSets(); ++i)
        {
            const osg::DrawElements* reduced = levels->reduced(i, level).elements;
            indices += reduced ? reduced->getNumIndices() : part->getPrimitiveSet(i)->getNumIndices();
        }
    }
    return indices / 3;
}

} // namespace

CharacterLevels::Part::Part(const SkinnedGeometry& mesh)
    : mesh(&mesh), vertices(mesh.getVertexArray()), modifiedCount(vertices ? vertices->getModifiedCount() : 0),
      state(mesh.getStateSet()), mask(mesh.getNodeMask())
{
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : mesh.getPrimitiveSetList())
        primitives.push_back({set, set->getModifiedCount()});
}

bool CharacterLevels::Part::isOf(const SkinnedGeometry& present) const
{
    if (&present != mesh || present.getVertexArray() != vertices || present.getStateSet() != state) return false;
    if (present.getNodeMask() != mask || (vertices && vertices->getModifiedCount() != modifiedCount)) return false;
    const osg::Geometry::PrimitiveSetList& sets = present.getPrimitiveSetList();
    return std::equal(sets.begin(), sets.end(), primitives.begin(), primitives.end(),
                      [](const osg::ref_ptr<osg::PrimitiveSet>& set, const Primitives& known)
                      { return set == known.set && set->getModifiedCount() == known.modifiedCount; });
}

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

CharacterLevels::CharacterLevels(const osg::Group& meshes, const AnimationSet& set) : _set(&set)
{
    forEachMesh(meshes, [&](const SkinnedGeometry& mesh) { _parts.emplace_back(mesh); });
    if (set.paletteSize() == 0 || _parts.size() > maxParts) return;
    std::vector<Parts> groups;
    for (const Part& part : _parts)
    {
        if (!MergedMesh::accepts(*part.mesh)) continue;
        const auto alike =
            std::find_if(groups.begin(), groups.end(),
                         [&](const Parts& group) { return MergedMesh::areAlike(*group.front(), *part.mesh); });
        if (alike == groups.end())
            groups.push_back({part.mesh});
        else
            alike->push_back(part.mesh);
    }
    if (groups.empty()) return;
    std::vector<std::vector<AffineMatrix>> palettes;
    for (const PoseInstruction& pose : keyPoses(set, LodLevels::poseCount))
        Pose::evaluate(set, pose, AffineMatrix(), palettes.emplace_back());
    for (const Parts& group : groups)
        merge(group, set, palettes);
}

void CharacterLevels::merge(const Parts& parts, const AnimationSet& set,
                            const std::vector<std::vector<AffineMatrix>>& palettes)
{
    MergedMesh mesh(parts, palettes);
    if (!mesh.isValid()) return;
    Merged merged{parts, {}};
    std::size_t kept = std::numeric_limits<std::size_t>::max();
    const int coarsest = LodLevels::levelOf(coarsestShare * mesh.size());
    for (int level = LodLevels::levelOf(finestShare * mesh.size()); level <= coarsest; ++level)
    {
        mesh.reduce(LodLevels::errorOf(level));
        if (static_cast<double>(mesh.triangleCount()) > worthwhile * static_cast<double>(kept)) continue;
        const MergedMesh::Made made = mesh.make(LodLevels::errorOf(level));
        if (!made.mesh) continue;
        kept = mesh.triangleCount();
        int from = level;
        while (from <= coarsest && mesh.similarity(usualPixel * LodLevels::errorOf(from)) < leastSimilarity)
            ++from;
        if (from > coarsest || (merged.steps.empty() && kept >= trianglesOf(parts, set, from))) continue;
        while (!merged.steps.empty() && merged.steps.back().level >= from)
            merged.steps.pop_back();
        merged.steps.push_back({from, made.mesh, made.error});
        if (kept <= fewestTriangles) break;
    }
    if (merged.steps.empty()) return;
    const int first = merged.steps.front().level;
    _finest = _finest == LodLevels::allTriangles ? first : std::min(_finest, first);
    _coarsest = std::max(_coarsest, merged.steps.back().level);
    _merged.push_back(merged);
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
    double largest = 0.0;
    for (const Merged& merged : _merged)
        if (const Step* step = merged.at(level)) largest = std::max(largest, step->error);
    return largest;
}

bool CharacterLevels::isMerged(const SkinnedGeometry& part, int level) const
{
    return std::any_of(_merged.begin(), _merged.end(),
                       [&](const Merged& merged) {
                           return merged.at(level) &&
                                  std::find(merged.parts.begin(), merged.parts.end(), &part) != merged.parts.end();
                       });
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
