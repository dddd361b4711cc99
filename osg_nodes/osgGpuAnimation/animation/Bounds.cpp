// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Bounds.h>

#include "ClipSweep.h"

#include <algorithm>
#include <cassert>

namespace osgGpuAnimation
{

void Box::add(const glm::vec3& point)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        min[axis] = std::min(min[axis], point[axis]);
        max[axis] = std::max(max[axis], point[axis]);
    }
}

void Box::add(const Box& box)
{
    if (box.empty()) return;
    add(box.min);
    add(box.max);
}

void Box::grow(float margin)
{
    if (empty()) return;
    min -= glm::vec3(margin);
    max += glm::vec3(margin);
}

glm::vec3 Box::corner(int i) const
{
    return {(i & 1) != 0 ? max.x : min.x, (i & 2) != 0 ? max.y : min.y, (i & 4) != 0 ? max.z : min.z};
}

Box boundsOfClip(const AnimationSet& set, int clip, const EntryBoxes& entryBoxes)
{
    assert(entryBoxes.size() == set.paletteSize() && "a box a palette entry");
    ClipSweep sweep(set, entryBoxes);
    if (clip < 0 || static_cast<std::size_t>(clip) >= set.clips().size()) return sweep.restPose();
    return sweep.clip(set.clips()[static_cast<std::size_t>(clip)]);
}

std::vector<Box> boundsOfClips(const AnimationSet& set, const EntryBoxes& entryBoxes)
{
    std::vector<Box> bounds;
    for (int clip = -1; clip < static_cast<int>(set.clips().size()); ++clip)
        bounds.push_back(boundsOfClip(set, clip, entryBoxes));
    return bounds;
}

} // namespace osgGpuAnimation
