// SPDX-License-Identifier: MIT
#include "ChainBinding.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace osgGpuAnimation::scenes
{

ChainBinding& ChainBinding::then(int joint, const glm::dvec3& head, const glm::dvec3& along, double halfWidth)
{
    _passages.push_back({joint, head, glm::normalize(along), halfWidth});
    return *this;
}

Binding ChainBinding::at(const glm::dvec3& point) const
{
    Binding result(_first);
    for (const Passage& passage : _passages)
    {
        const double along = glm::dot(point - passage.head, passage.along);
        const double share = glm::smoothstep(-passage.halfWidth, passage.halfWidth, along);
        if (share > 0.0) result.give(share, passage.joint);
    }
    return result;
}

} // namespace osgGpuAnimation::scenes
