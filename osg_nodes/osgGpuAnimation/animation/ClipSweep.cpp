// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipSweep.h>

#include <osgGpuAnimation/animation/Rotation.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

ClipSweep::ClipSweep(const AnimationSet& set, const EntryBoxes& entryBoxes)
    : _set(set), _isNeeded(set.skeleton().jointCount(), false), _placements(set.skeleton().jointCount()),
      _motions(set.skeleton().jointCount())
{
    const std::size_t count = std::min(entryBoxes.size(), set.paletteSize());
    for (std::size_t e = 0; e < count; ++e)
        if (set.palette()[e].joint >= 0 && !entryBoxes[e].empty())
        {
            _parts.push_back(partOf(set.palette()[e], entryBoxes[e]));
            _isNeeded[_parts.back().joint] = true;
        }
    for (std::size_t j = _isNeeded.size(); j-- > 0;)
        if (_isNeeded[j] && set.skeleton().joint(j).parent >= 0)
            _isNeeded[static_cast<std::size_t>(set.skeleton().joint(j).parent)] = true;
    _boxes.resize(_parts.size());
}

ClipSweep::Part ClipSweep::partOf(const PaletteEntry& entry, const Box& box)
{
    const glm::dvec3 min(box.min), max(box.max);
    const glm::dvec3 half = (max - min) * 0.5;
    const glm::dmat4 inverseBind = entry.inverseBind.toColumns();
    Part part;
    part.joint = static_cast<std::size_t>(entry.joint);
    part.centre = glm::dvec3(inverseBind * glm::dvec4((min + max) * 0.5, 1.0));
    for (int axis = 0; axis < 3; ++axis)
        part.halfEdges[axis] = glm::dvec3(inverseBind[axis]) * half[axis];
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::dvec3 signs((corner & 1) ? 1.0 : -1.0, (corner & 2) ? 1.0 : -1.0, (corner & 4) ? 1.0 : -1.0);
        part.radius = std::max(part.radius, glm::length(part.centre + part.halfEdges * signs));
    }
    return part;
}

void ClipSweep::lookAt(const KeyframePair& keyframes)
{
    for (std::size_t j = 0; j < _placements.size(); ++j)
    {
        if (!_isNeeded[j]) continue;
        const MixedTrack local = MixedTrack::between(keyframes, j, false);
        glm::dmat3 linear = Rotation::matrix(local.rotation);
        for (int axis = 0; axis < 3; ++axis)
            linear[axis] *= local.scale[axis];
        const int parent = _set.skeleton().joint(j).parent;
        if (parent < 0)
        {
            _placements[j] = {linear, glm::dvec3(local.translation)};
            continue;
        }
        const Placement& above = _placements[static_cast<std::size_t>(parent)];
        _placements[j] = {above.linear * linear, above.linear * glm::dvec3(local.translation) + above.origin};
    }
    for (std::size_t p = 0; p < _parts.size(); ++p)
    {
        const Part& part = _parts[p];
        const Placement& placement = _placements[part.joint];
        const glm::dmat3 edges = placement.linear * part.halfEdges;
        _boxes[p] = SweptBox::about(placement.linear * part.centre + placement.origin,
                                    glm::abs(edges[0]) + glm::abs(edges[1]) + glm::abs(edges[2]));
        _seen.add(_boxes[p]);
    }
}

void ClipSweep::boundMotion(const KeyframePair& keyframes)
{
    for (std::size_t j = 0; j < _motions.size(); ++j)
    {
        if (!_isNeeded[j]) continue;
        const int parent = _set.skeleton().joint(j).parent;
        const ChainMotion above = parent < 0 ? ChainMotion() : _motions[static_cast<std::size_t>(parent)];
        _motions[j] = above.child(TrackMotion::between(keyframes, j));
    }
}

int ClipSweep::stepsNeeded() const
{
    constexpr double mostSteps = 16.0;
    const double allowed = 0.01 * _seen.diagonal();
    double steps = 1.0;
    for (std::size_t p = 0; p < _parts.size(); ++p)
    {
        const double strayed = _motions[_parts[p].joint].strayed(_parts[p].radius);
        if (!(strayed > allowed) || !std::isfinite(strayed)) continue;
        SweptBox both = _boxes[p];
        both.add(_boxesBefore[p]);
        steps = std::max(steps, std::ceil(std::sqrt(strayed / (allowed + _seen.slackAround(both)))));
    }
    return static_cast<int>(std::min(steps, mostSteps));
}

void ClipSweep::gatherStrayed(const std::vector<SweptBox>& boxes, int steps)
{
    for (std::size_t p = 0; p < boxes.size(); ++p)
    {
        const ChainMotion& motion = _motions[_parts[p].joint];
        const double strayed = motion.strayed(_parts[p].radius) / (static_cast<double>(steps) * steps);
        _swept.add(boxes[p].grownWithin(strayed, motion.reach(_parts[p].radius)));
    }
}

void ClipSweep::sweepPiece(KeyframePair keyframes)
{
    boundMotion(keyframes);
    const int steps = stepsNeeded();
    gatherStrayed(_boxesBefore, steps);
    gatherStrayed(_boxes, steps);
    if (steps == 1) return;

    const std::vector<SweptBox> boxesAfter = _boxes;
    for (int step = 1; step < steps; ++step)
    {
        keyframes.alpha = static_cast<double>(step) / steps;
        lookAt(keyframes);
        gatherStrayed(_boxes, steps);
    }
    _boxes = boxesAfter;
}

Box ClipSweep::restPose()
{
    _seen = SweptBox();
    const JointTransform* rest = _set.restPose().data();
    lookAt({rest, rest, 0.0, false});
    return _seen.toBox();
}

Box ClipSweep::clip(const Clip& clip)
{
    _seen = _swept = SweptBox();
    const bool spline = clip.form() == Clip::Form::Spline;
    for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
    {
        const JointTransform* keyframe = clip.data().data() + k * clip.keyframeStride();
        _boxesBefore = _boxes;
        lookAt({keyframe, keyframe, 0.0, spline});
        if (k > 0 && clip.times()[k - 1] < clip.times()[k])
            sweepPiece({keyframe - clip.keyframeStride(), keyframe, 0.0, spline});
    }
    _swept.add(_seen);
    return _swept.toBox();
}

} // namespace osgGpuAnimation
