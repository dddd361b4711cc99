// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/MotionBlend.h>

#include <osgGpuAnimation/animation/RootMotionCurve.h>

#include <algorithm>

namespace osgGpuAnimation
{

RootMotion rootMotionOf(const Clip& clip, const ClipMove& move, LoopMode loopMode)
{
    if (move.distance == 0.0) return {glm::dvec3(0.0), 0.0, clip.rootMotion()->up};
    const RootMotion before = clip.rootMotionAt(move.from).inverse();
    if (loopMode != LoopMode::Loop || move.crossings == 0.0) return before * clip.rootMotionAt(move.to);
    return before * clip.rootMotionAt(clip.duration()).power(move.crossings) * clip.rootMotionAt(move.to);
}

void MotionBlend::add(const RootMotion& motion, double weight, int standing)
{
    std::size_t place = _count;
    while (place > 0 && _standings[place - 1].number > standing)
        --place;
    if (place == 0 || _standings[place - 1].number != standing)
    {
        const auto begin = _standings.begin();
        const auto end = begin + static_cast<std::ptrdiff_t>(_count++);
        std::move_backward(begin + static_cast<std::ptrdiff_t>(place), end, end + 1);
        _standings[place] = {standing, 0.0, {}};
        ++place;
    }
    Standing& here = _standings[place - 1];
    here.weight += weight;
    here.sum.translation += motion.translation * weight;
    here.sum.yaw += motion.yaw * weight;
    here.sum.up = motion.up;
}

RootMotion MotionBlend::result() const
{
    RootMotion total;
    for (std::size_t i = 0; i < _count; ++i)
    {
        const Standing& standing = _standings[i];
        const double left = 1.0 - std::min(standing.weight, 1.0);
        const double share = 1.0 / std::max(standing.weight, 1.0);
        total.translation = total.translation * left + standing.sum.translation * share;
        total.yaw = total.yaw * left + standing.sum.yaw * share;
        total.up = standing.sum.up;
    }
    return total;
}

} // namespace osgGpuAnimation
