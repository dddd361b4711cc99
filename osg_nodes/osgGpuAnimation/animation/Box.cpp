// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Box.h>

#include <algorithm>

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

} // namespace osgGpuAnimation
