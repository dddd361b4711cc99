// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/lod/CharacterLevels.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/lod/MergedMesh.h>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

constexpr double worthwhileShare = 0.85; ///< a level has at most this share of the previous level's triangles
constexpr std::size_t fewestTriangles = 4;

} // namespace

bool CharacterLevels::Part::operator==(const Part& other) const
{
    return mesh == other.mesh && vertices == other.vertices && modifiedCount == other.modifiedCount &&
           state == other.state && mask == other.mask && hasDrawCallback == other.hasDrawCallback;
}

std::vector<CharacterLevels::Part> CharacterLevels::partsOf(const osg::Group& meshes)
{
    std::vector<Part> parts;
    forEachMesh(meshes,
                [&](const SkinnedGeometry& mesh)
                {
                    const osg::Array* vertices = mesh.getVertexArray();
                    parts.push_back({&mesh, vertices, vertices ? vertices->getModifiedCount() : 0, mesh.getStateSet(),
                                     mesh.getNodeMask(), mesh.getDrawCallback() != nullptr});
                });
    return parts;
}

bool CharacterLevels::isOf(const osg::Group& meshes, const AnimationSet& set) const
{
    return &set == _set && partsOf(meshes) == _parts &&
           std::all_of(_merged.begin(), _merged.end(), [](const Merged& merged) { return merged.look->isPresent(); });
}

CharacterLevels::CharacterLevels(const osg::Group& meshes, const AnimationSet& set)
    : _set(&set), _parts(partsOf(meshes))
{
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
        merge(group, palettes);
}

void CharacterLevels::merge(const Parts& parts, const std::vector<std::vector<AffineMatrix>>& palettes)
{
    MergedMesh mesh(parts, palettes);
    if (!mesh.isValid()) return;
    Merged merged{parts, mesh.look(), {}};
    std::size_t kept = mesh.triangleCount();
    for (int level = mesh.finest(); level <= mesh.coarsest() && kept > fewestTriangles; ++level)
    {
        mesh.reduceTo(level);
        if (static_cast<double>(mesh.triangleCount()) > worthwhileShare * static_cast<double>(kept)) continue;
        const osg::ref_ptr<SkinnedGeometry> made = mesh.make(level);
        if (!made) continue;
        kept = mesh.triangleCount();
        merged.steps.push_back({level, made});
    }
    if (merged.steps.empty()) return;
    const int first = merged.steps.front().level;
    _finest = _finest == LodLevels::allTriangles ? first : std::min(_finest, first);
    _coarsest = std::max(_coarsest, merged.steps.back().level);
    _merged.push_back(merged);
}

bool CharacterLevels::Merged::contains(const SkinnedGeometry& part) const
{
    return std::find(parts.begin(), parts.end(), &part) != parts.end();
}

const SkinnedGeometry* CharacterLevels::Merged::at(int level) const
{
    const SkinnedGeometry* found = nullptr;
    for (const Step& step : steps)
        if (step.level <= level) found = step.mesh;
    return found;
}

const CharacterLevels::Merged* CharacterLevels::mergedWith(const SkinnedGeometry& part) const
{
    const auto found =
        std::find_if(_merged.begin(), _merged.end(), [&](const Merged& merged) { return merged.contains(part); });
    return found == _merged.end() ? nullptr : &*found;
}

bool CharacterLevels::contains(const SkinnedGeometry& part) const
{
    return mergedWith(part) != nullptr;
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
