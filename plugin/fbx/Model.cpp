// SPDX-License-Identifier: MIT
#include "fbx/Model.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace osgGpuAnimation::fbx
{

namespace
{

glm::dquat turn(double degrees, const glm::dvec3& axis)
{
    return glm::angleAxis(glm::radians(degrees), axis);
}

} // namespace

glm::dquat rotationOf(const glm::dvec3& angles, int order)
{
    const glm::dquat x = turn(angles.x, {1, 0, 0}), y = turn(angles.y, {0, 1, 0}), z = turn(angles.z, {0, 0, 1});
    switch (order)
    {
    case 1:
        return y * z * x;
    case 2:
        return x * z * y;
    case 3:
        return z * x * y;
    case 4:
        return y * x * z;
    case 5:
        return x * y * z;
    default:
        return z * y * x;
    }
}

Placement Model::placement(const glm::dvec3& lclTranslation, const glm::dvec3& lclRotation,
                           const glm::dvec3& lclScaling) const
{
    Placement made;
    made.rotation = rotationOf(preRotation, 0) * rotationOf(lclRotation, rotationOrder) *
                    glm::conjugate(rotationOf(postRotation, 0));
    made.scale = lclScaling;
    made.translation = lclTranslation + rotationOffset + rotationPivot +
                       made.rotation * (scalingOffset + scalingPivot - rotationPivot - lclScaling * scalingPivot);
    return made;
}

bool Model::hasPivots() const
{
    return rotationPivot != glm::dvec3(0.0) || scalingOffset != glm::dvec3(0.0) || scalingPivot != glm::dvec3(0.0);
}

double ShapeChannel::weight(std::size_t target, double atPercent) const
{
    if (target >= targets()) return 0.0;
    constexpr std::size_t base = std::numeric_limits<std::size_t>::max();
    std::vector<std::pair<double, std::size_t>> shapes{{0.0, base}};
    for (std::size_t i = 0; i < targets(); ++i)
        shapes.emplace_back(fullPercents.size() == targets() ? fullPercents[i] : 100.0, i);
    std::sort(shapes.begin() + 1, shapes.end());
    std::inplace_merge(shapes.begin(), shapes.begin() + 1, shapes.end());
    std::size_t next = 1;
    while (next + 1 < shapes.size() && atPercent > shapes[next].first)
        ++next;
    const auto [from, first] = shapes[next - 1];
    const auto [to, last] = shapes[next];
    const double share = to > from ? (atPercent - from) / (to - from) : 0.0;
    return target == last ? share : target == first ? 1.0 - share : 0.0;
}

} // namespace osgGpuAnimation::fbx
