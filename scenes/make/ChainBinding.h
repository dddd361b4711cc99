// SPDX-License-Identifier: MIT
#pragma once

#include "Binding.h"

#include <glm/vec3.hpp>

#include <vector>

namespace osgGpuAnimation::scenes
{

/// Binds points along a limb: one joint follows the other, with a soft passage around each joint's head. A wide
/// passage bends like cloth, a narrow one like a hinge.
class ChainBinding
{
public:
    explicit ChainBinding(int firstJoint) : _first(firstJoint) {}

    /// From `head` on, in the direction `along`, the joint takes over, within +-halfWidth metres.
    ChainBinding& then(int joint, const glm::dvec3& head, const glm::dvec3& along, double halfWidth);

    Binding at(const glm::dvec3& point) const;

private:
    struct Passage
    {
        int joint;
        glm::dvec3 head;
        glm::dvec3 along;
        double halfWidth;
    };

    int _first;
    std::vector<Passage> _passages;
};

} // namespace osgGpuAnimation::scenes
