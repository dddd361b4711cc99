// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PickedJoint.h>

#include <algorithm>
#include <map>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// A vertex and its share in the hit point.
struct Corner
{
    std::size_t vertex;
    double share;
};

std::optional<std::size_t> heaviestJoint(const AnimationSet& set, const SkinnedGeometry& mesh,
                                         const std::vector<Corner>& corners)
{
    std::map<int, double> weightOfJoint;
    for (const Corner& corner : corners)
        mesh.forEachInfluence(corner.vertex,
                              [&](std::size_t entry, float weight)
                              {
                                  const int joint = entry < set.paletteSize() ? set.palette()[entry].joint : -1;
                                  if (joint >= 0) weightOfJoint[joint] += corner.share * static_cast<double>(weight);
                              });
    const auto heaviest = std::max_element(weightOfJoint.begin(), weightOfJoint.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
    if (heaviest == weightOfJoint.end()) return std::nullopt;
    return static_cast<std::size_t>(heaviest->first);
}

/// What the hit names, without the joint.
template <typename Intersection>
std::optional<PickedJoint> pick(const Intersection& hit)
{
    PickedJoint picked;
    picked.mesh = dynamic_cast<SkinnedGeometry*>(hit.drawable.get());
    if (!picked.mesh) return std::nullopt;
    const std::optional<AnimatedCrowd::Instance> instance = instanceOf(hit);
    for (osg::Node* node : hit.nodePath)
    {
        auto* crowd = instance ? dynamic_cast<AnimatedCrowd*>(node) : nullptr;
        auto* character = instance ? nullptr : dynamic_cast<AnimatedCharacter*>(node);
        if (crowd) picked.crowd = crowd;
        if (character) picked.character = character;
    }
    if (!picked.crowd && !picked.character) return std::nullopt;
    if (picked.crowd) picked.instance = *instance;
    picked.set = picked.crowd ? &picked.crowd->getAnimationSet() : &picked.character->getAnimationSet();
    return picked;
}

std::optional<PickedJoint> withJoint(PickedJoint picked, const std::vector<Corner>& corners)
{
    const std::optional<std::size_t> joint = heaviestJoint(*picked.set, *picked.mesh, corners);
    if (!joint) return std::nullopt;
    picked.joint = *joint;
    return picked;
}

} // namespace

std::optional<PickedJoint> jointOf(const osgUtil::LineSegmentIntersector::Intersection& hit)
{
    const std::optional<PickedJoint> picked = pick(hit);
    if (!picked) return std::nullopt;
    std::vector<Corner> corners;
    for (std::size_t i = 0; i < std::min(hit.indexList.size(), hit.ratioList.size()); ++i)
        corners.push_back({hit.indexList[i], hit.ratioList[i]});
    return withJoint(*picked, corners);
}

std::optional<PickedJoint> jointOf(const osgUtil::PolytopeIntersector::Intersection& hit)
{
    const std::optional<PickedJoint> picked = pick(hit);
    if (!picked) return std::nullopt;
    const osg::ref_ptr<osg::Geometry> posed = picked->crowd
                                                  ? picked->crowd->getPosedMesh(picked->instance, *picked->mesh)
                                                  : picked->character->getPosedMesh(*picked->mesh);
    const auto* positions = dynamic_cast<const osg::Vec3Array*>(posed->getVertexArray());
    if (!positions || positions->empty()) return std::nullopt;
    const osg::Vec3 point(hit.localIntersectionPoint);
    const auto nearest = std::min_element(positions->begin(), positions->end(),
                                          [&](const osg::Vec3& a, const osg::Vec3& b)
                                          { return (a - point).length2() < (b - point).length2(); });
    return withJoint(*picked, {{static_cast<std::size_t>(nearest - positions->begin()), 1.0}});
}

} // namespace osgGpuAnimation
