// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/MixBounds.h>

#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// Bounds of a joint's transform to model space, v -> A v + p: a ball that contains p, and the distance of A from a
/// centre.
struct JointToModelBound
{
    glm::dmat3 linear{1.0}; ///< the centre
    double norm = 1.0;      ///< bound of |centre|
    double deviation = 0.0; ///< bound of |A - centre|
    double maxNorm = 1.0;   ///< bound of |A|
    glm::dvec3 origin{0.0}; ///< centre of the ball
    double radius = 0.0;    ///< of the ball

    JointToModelBound child(const JointRange& range) const
    {
        JointToModelBound result;
        const double distance = glm::length(range.translation) + range.shift;
        const double directed = norm * range.shift + deviation * distance;
        const double undirected = maxNorm * distance;
        result.origin = directed <= undirected ? origin + linear * range.translation : origin;
        result.radius = radius + std::min(directed, undirected);

        // |R S - R0 S0| <= |R - R0| |S| + |S - S0|, and a turn by an angle moves a unit vector by 2 sin of its half.
        const double size = maxComponent(glm::abs(range.scale) + range.stretch);
        const double turned = range.turn < 1.5 ? 2.0 * std::sin(range.turn) : 2.0;
        const double own = turned * size + range.stretch;
        const double ownNorm = maxComponent(range.scale);
        result.maxNorm = maxNorm * size;
        result.linear = linear * Rotation::matrix(range.rotation);
        for (int axis = 0; axis < 3; ++axis)
            result.linear[axis] *= range.scale[axis];
        result.norm = norm * ownNorm;
        result.deviation = norm * own + deviation * (ownNorm + own);
        if (result.deviation <= result.maxNorm) return result;
        result.linear = glm::dmat3(0.0);
        result.norm = 0.0;
        result.deviation = result.maxNorm;
        return result;
    }
};

/// The box of a palette entry after its joint's transform.
Aabb3d transformed(const PaletteEntry& entry, const Box& entryBox, const JointToModelBound& bound)
{
    const TransformedBox box(entry.inverseBind, entryBox);
    double radius = glm::length(box.centre); // no point of the box is farther from the joint's origin
    for (int axis = 0; axis < 3; ++axis)
        radius += glm::length(box.halfEdges[axis]);
    return box.bounds(bound.linear, bound.origin, bound.radius + bound.deviation * radius);
}

} // namespace

MixBounds::MixBounds(const AnimationSet& set, Boxes boxes) : _set(set), _boxes(std::move(boxes))
{
    for (const MorphWeights& morph : set.morphs())
        for (const float weight : morph.isProperty() ? std::vector<float>() : morph.defaults)
            _maxRestWeight = std::max(_maxRestWeight, std::abs(static_cast<double>(weight)));
}

const Clip* MixBounds::findClip(int clip) const
{
    const bool isKnown = clip >= 0 && static_cast<std::size_t>(clip) < _set.clips().size();
    return isKnown ? &_set.clips()[clip] : nullptr;
}

std::shared_ptr<const MixBounds::Ranges> MixBounds::rangesOf(int clip) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::shared_ptr<const Ranges>& known = _ranges[clip];
    if (!known) known = std::make_shared<const Ranges>(rangesOfClip(_set, findClip(clip)));
    return known;
}

MixBounds::Ranges MixBounds::rangesOf(const std::vector<PlayedClip>& played) const
{
    Ranges result;
    for (const PlayedClip& clip : played)
    {
        if (clip.part != PlayedClip::Part::Mixed || clip.pose) continue;
        const std::shared_ptr<const Ranges> ranges = rangesOf(clip.clip);
        if (result.empty())
            result = *ranges;
        else
            for (std::size_t joint = 0; joint < result.size(); ++joint)
                result[joint].add((*ranges)[joint]);
    }
    if (result.empty()) result = *rangesOf(-1);
    for (const PlayedClip& clip : played)
        if (clip.pose && clip.part == PlayedClip::Part::Mixed)
            for (std::size_t joint = 0; joint < clip.pose->joints.size(); ++joint)
                result[joint].add(clip.pose->joints[joint].range(result[joint]));
    for (const PlayedClip& clip : played)
    {
        if (clip.part == PlayedClip::Part::Mixed) continue;
        if (clip.pose)
        {
            for (std::size_t joint = 0; joint < clip.pose->joints.size(); ++joint)
            {
                const JointTransform& rest = _set.restPose()[joint];
                result[joint].addDifference(clip.pose->joints[joint].range(JointRange::of(rest)), rest);
            }
            continue;
        }
        const Clip* reference = clip.part == PlayedClip::Part::AddedToItsFirst ? findClip(clip.clip) : nullptr;
        const std::shared_ptr<const Ranges> ranges = rangesOf(clip.clip);
        for (std::size_t joint = 0; joint < result.size(); ++joint)
            result[joint].addDifference((*ranges)[joint],
                                        reference ? *reference->at(0, joint) : _set.restPose()[joint]);
    }
    return result;
}

/// The box of the vertices that the entry moves, in bind pose, for all morph weights that can occur.
Box MixBounds::entryBox(const std::vector<PlayedClip>& played, std::size_t entry) const
{
    bool isPosed = false, isAdded = false;
    double posed = 1.0, added = 0.0; // the largest weight of poses that are mixed, and the sum of those that are added
    for (const PlayedClip& clip : played)
    {
        const bool isMixed = clip.part == PlayedClip::Part::Mixed;
        isAdded = isAdded || !(isMixed || clip.pose);
        if (!clip.pose || !(clip.pose->maxWeight > 0.0)) continue;
        isPosed = isPosed || isMixed;
        if (isMixed)
            posed = std::max(posed, clip.pose->maxWeight);
        else
            added += clip.pose->maxWeight + _maxRestWeight;
    }
    Box box = _boxes.ofClips[entry];
    if (isAdded) box.add(_boxes.withAdded[entry]);
    if (isPosed) box.add(_boxes.withPosed[entry]);
    // Additive clips change the weights of poses, too: by at most the size of their box.
    if (isAdded && isPosed) box.grow(glm::distance(_boxes.withAdded[entry].min, _boxes.withAdded[entry].max));
    box.grow(_boxes.reaches[entry] * static_cast<float>(posed - 1.0 + added));
    return box;
}

Box MixBounds::box(const std::vector<PlayedClip>& played, std::uint64_t constraints) const
{
    Ranges ranges = rangesOf(played);
    for (std::size_t c = 0; c < _set.constraintChains().size(); ++c)
        if (constraints >> c & 1)
            for (const int joint : _set.constraintChains()[c].joints)
                ranges[joint].turn = JointRange::anyTurn;
    std::vector<JointToModelBound> bounds;
    for (std::size_t joint = 0; joint < ranges.size(); ++joint)
    {
        const int parent = _set.skeleton().joint(joint).parent;
        const JointToModelBound above = parent < 0 ? JointToModelBound() : bounds[parent];
        bounds.push_back(above.child(ranges[joint]));
    }
    Aabb3d all;
    for (std::size_t e = 0; e < std::min(_boxes.ofClips.size(), _set.paletteSize()); ++e)
    {
        const PaletteEntry& entry = _set.palette()[e];
        if (entry.joint < 0 || _boxes.ofClips[e].empty()) continue;
        all.add(transformed(entry, entryBox(played, e), bounds[entry.joint]));
    }
    return all.toBox();
}

} // namespace osgGpuAnimation
