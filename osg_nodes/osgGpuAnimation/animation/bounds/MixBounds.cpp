// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/MixBounds.h>

#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/math/Box.h>

#include <osgGpuAnimation/animation/JointTransform.h>

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
struct Reach
{
    glm::dmat3 linear{1.0};
    double norm = 1.0;      ///< bound of |centre of A|
    double deviation = 0.0; ///< bound of |A - centre|
    double largest = 1.0;   ///< bound of |A|
    glm::dvec3 place{0.0};
    double radius = 0.0;

    Reach child(const JointRange& range) const;
};

double largestOf(const glm::dvec3& v)
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Reach Reach::child(const JointRange& range) const
{
    Reach result;
    const double distance = glm::length(range.translation) + range.shift;
    const double directed = norm * range.shift + deviation * distance;
    const double undirected = largest * distance;
    result.place = directed <= undirected ? place + linear * range.translation : place;
    result.radius = radius + std::min(directed, undirected);

    // |R S - R0 S0| <= |R - R0| |S| + |S - S0|, and a turn by an angle moves a unit vector by 2 sin of its half.
    const double size = largestOf(glm::abs(range.scale) + range.stretch);
    const double turned = range.turn < 1.5 ? 2.0 * std::sin(range.turn) : 2.0;
    const double own = turned * size + range.stretch;
    const double ownNorm = largestOf(range.scale);
    result.largest = largest * size;
    result.linear = linear * Rotation::matrix(range.rotation);
    for (int axis = 0; axis < 3; ++axis)
        result.linear[axis] *= range.scale[axis];
    result.norm = norm * ownNorm;
    result.deviation = norm * own + deviation * (ownNorm + own);
    if (result.deviation <= result.largest) return result;
    result.linear = glm::dmat3(0.0);
    result.norm = 0.0;
    result.deviation = result.largest;
    return result;
}

/// The box of a palette entry after its joint's transform.
Aabb3d moved(const PaletteEntry& entry, const Box& box, const Reach& reach)
{
    const glm::dvec3 min(box.min), max(box.max);
    const glm::dmat4 inverseBind = entry.inverseBind.toColumns();
    const glm::dvec3 centre(inverseBind * glm::dvec4((min + max) * 0.5, 1.0));
    glm::dmat3 edges;
    double span = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        edges[axis] = glm::dvec3(inverseBind[axis]) * (max - min)[axis] * 0.5;
        span += glm::length(edges[axis]);
    }
    const glm::dmat3 placed = reach.linear * edges;
    const double margin = reach.radius + reach.deviation * (glm::length(centre) + span);
    return Aabb3d::about(reach.place + reach.linear * centre,
                         glm::abs(placed[0]) + glm::abs(placed[1]) + glm::abs(placed[2]) + margin);
}

} // namespace

MixBounds::MixBounds(const AnimationSet& set, EntryBoxes entryBoxes, EntryBoxes withAdded)
    : _set(set), _entryBoxes(std::move(entryBoxes)), _withAdded(std::move(withAdded))
{
}

MixBounds::~MixBounds() = default;

std::shared_ptr<const MixBounds::Ranges> MixBounds::rangesOf(int clip) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::shared_ptr<const Ranges>& known = _ranges[clip];
    if (known) return known;
    Ranges ranges;
    if (clip >= 0 && static_cast<std::size_t>(clip) < _set.clips().size())
        ranges = rangesOfClip(_set, _set.clips()[static_cast<std::size_t>(clip)]);
    else
        for (std::size_t joint = 0; joint < _set.skeleton().jointCount(); ++joint)
            ranges.push_back(JointRange::of(_set.restPose()[joint]));
    known = std::make_shared<const Ranges>(std::move(ranges));
    return known;
}

const JointTransform& MixBounds::firstOf(int clip, std::size_t joint) const
{
    if (clip < 0 || static_cast<std::size_t>(clip) >= _set.clips().size()) return _set.restPose()[joint];
    const Clip& source = _set.clips()[static_cast<std::size_t>(clip)];
    if (source.keyframeCount() == 0) return _set.restPose()[joint];
    return *source.at(source.locate(0.0).keyframe, joint);
}

MixBounds::Ranges MixBounds::rangesOf(const std::vector<PlayedClip>& played) const
{
    Ranges result;
    for (const PlayedClip& clip : played)
    {
        if (clip.part != PlayedClip::Part::Mixed) continue;
        const std::shared_ptr<const Ranges> ranges = rangesOf(clip.clip);
        if (result.empty())
            result = *ranges;
        else
            for (std::size_t joint = 0; joint < result.size(); ++joint)
                result[joint].add((*ranges)[joint]);
    }
    if (result.empty()) result = *rangesOf(-1);
    for (const PlayedClip& clip : played)
    {
        if (clip.part == PlayedClip::Part::Mixed) continue;
        const bool isToRest = clip.part == PlayedClip::Part::AddedToRest;
        const std::shared_ptr<const Ranges> ranges = rangesOf(clip.clip);
        for (std::size_t joint = 0; joint < result.size(); ++joint)
            result[joint].addDifference((*ranges)[joint], firstOf(isToRest ? -1 : clip.clip, joint));
    }
    return result;
}

Box MixBounds::box(const std::vector<PlayedClip>& played) const
{
    const Ranges ranges = rangesOf(played);
    std::vector<Reach> reaches;
    for (std::size_t joint = 0; joint < ranges.size(); ++joint)
    {
        const int parent = _set.skeleton().joint(joint).parent;
        const Reach above = parent < 0 ? Reach() : reaches[static_cast<std::size_t>(parent)];
        reaches.push_back(above.child(ranges[joint]));
    }
    const bool isAdded = std::any_of(played.begin(), played.end(),
                                     [](const PlayedClip& clip) { return clip.part != PlayedClip::Part::Mixed; });
    const EntryBoxes& boxes = isAdded ? _withAdded : _entryBoxes;
    Aabb3d all;
    for (std::size_t e = 0; e < std::min(boxes.size(), _set.paletteSize()); ++e)
    {
        const PaletteEntry& entry = _set.palette()[e];
        if (entry.joint < 0 || boxes[e].empty()) continue;
        all.add(moved(entry, boxes[e], reaches[static_cast<std::size_t>(entry.joint)]));
    }
    return all.toBox();
}

} // namespace osgGpuAnimation
