// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/bounds/JointRange.h>

#include <osg/ComputeBoundsVisitor>
#include <osg/CullStack>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

glm::vec3 toGlm(const osg::Vec3& vector)
{
    return {vector.x(), vector.y(), vector.z()};
}

using Weights = PaletteEntryBounds::Weights;

std::vector<WeightRange> rangesOf(const AnimationSet& set, std::size_t morph, Weights weights)
{
    std::vector<WeightRange> ranges = weightRanges(set, morph);
    for (WeightRange& range : ranges)
    {
        const float added = weights == Weights::WithAdded ? (range.max - range.min) * maxLayers : 0.0f;
        range = {range.min - added, range.max + added};
        if (weights == Weights::WithPosed) range = {std::min(range.min, -1.0f), std::max(range.max, 1.0f)};
    }
    return ranges;
}

/// The farthest that weights in [-1, 1] move the vertex.
float reachOfVertex(std::size_t vertex, const std::vector<MorphTarget>& targets)
{
    float reach = 0.0f;
    for (const MorphTarget& target : targets)
        if (const osg::Vec3Array* deltas = target.positions.get(); deltas && vertex < deltas->size())
            reach += (*deltas)[vertex].length();
    return reach;
}

/// The box of all morphed positions of one vertex.
Box boundsOfVertex(const osg::Vec3& position, std::size_t vertex, const std::vector<MorphTarget>& targets,
                   const std::vector<WeightRange>& ranges)
{
    Box bounds;
    bounds.add(toGlm(position));
    for (std::size_t target = 0; target < std::min(targets.size(), ranges.size()); ++target)
    {
        const osg::Vec3Array* deltas = targets[target].positions.get();
        if (!deltas || vertex >= deltas->size()) continue;
        const glm::vec3 delta = toGlm((*deltas)[vertex]);
        bounds.min += glm::min(delta * ranges[target].min, delta * ranges[target].max);
        bounds.max += glm::max(delta * ranges[target].min, delta * ranges[target].max);
    }
    return bounds;
}

} // namespace

bool computesBounds(osg::NodeVisitor& visitor)
{
    if (visitor.asCullVisitor()) return false;
    return dynamic_cast<osg::ComputeBoundsVisitor*>(&visitor) || dynamic_cast<osg::CullStack*>(&visitor);
}

void traverseWithBounds(osg::Group& group, const osg::BoundingBox& box, osg::NodeVisitor& visitor)
{
    bool isVisited = false;
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
    {
        osg::Node& child = *group.getChild(i);
        if (!dynamic_cast<const SkinnedGeometry*>(&child))
        {
            child.accept(visitor);
            continue;
        }
        if (isVisited || !visitor.validNodeMask(child)) continue;
        isVisited = true;
        const osg::ref_ptr<osg::Drawable> now = new osg::Drawable;
        now->setInitialBound(box);
        now->accept(visitor);
    }
}

PaletteEntryBounds::PaletteEntryBounds(const AnimationSet& set, Weights weights)
    : _set(&set), _weights(weights), _boxes(set.paletteSize()), _reaches(set.paletteSize())
{
}

void PaletteEntryBounds::add(const SkinnedGeometry& mesh)
{
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(mesh.getVertexArray());
    if (!vertices) return;
    if (mesh.getRigidEntry() >= 0 && mesh.getMorph() < 0)
    {
        const auto entry = static_cast<std::size_t>(mesh.getRigidEntry());
        const auto [known, isNew] = _bindBoxes.try_emplace(vertices);
        for (std::size_t vertex = 0; isNew && vertex < vertices->size(); ++vertex)
            known->second.add(toGlm((*vertices)[vertex]));
        if (entry < _boxes.size()) _boxes[entry].add(known->second);
        return;
    }
    std::vector<WeightRange> ranges;
    if (mesh.getMorph() >= 0) ranges = rangesOf(*_set, static_cast<std::size_t>(mesh.getMorph()), _weights);
    for (std::size_t vertex = 0; vertex < vertices->size(); ++vertex)
    {
        const Box bounds = boundsOfVertex((*vertices)[vertex], vertex, mesh.getMorphTargets(), ranges);
        const float reach = reachOfVertex(vertex, mesh.getMorphTargets());
        mesh.forEachInfluence(vertex,
                              [&](std::size_t entry, float)
                              {
                                  if (entry >= _boxes.size()) return;
                                  _boxes[entry].add(bounds);
                                  _reaches[entry] = std::max(_reaches[entry], reach);
                              });
    }
}

MixBounds::Boxes mixBoxesOf(const std::vector<const SkinnedGeometry*>& meshes, const AnimationSet& set)
{
    const auto boundsOf = [&](Weights weights)
    {
        PaletteEntryBounds bounds(set, weights);
        for (const SkinnedGeometry* mesh : meshes)
            bounds.add(*mesh);
        return bounds;
    };
    const PaletteEntryBounds ofClips = boundsOf(Weights::OfClips);
    if (set.morphs().empty()) return {ofClips.boxes(), ofClips.boxes(), ofClips.boxes(), ofClips.reaches()};
    return {ofClips.boxes(), boundsOf(Weights::WithAdded).boxes(), boundsOf(Weights::WithPosed).boxes(),
            ofClips.reaches()};
}

} // namespace osgGpuAnimation
