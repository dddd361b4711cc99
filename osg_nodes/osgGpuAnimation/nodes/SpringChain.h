// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec3>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// One joint of a spring chain. Lengths are in the units of the set's file; a scale of the character scales them.
struct SpringJoint
{
    std::string joint;      ///< its name
    float stiffness = 1.0f; ///< how strongly it returns to its rest rotation: length per second, at least 0
    float drag = 0.4f;      ///< the share of its speed that it loses per substep, in [0, 1]
    float gravity = 0.0f;   ///< length per second
    osg::Vec3 gravityDirection{0, 0, -1}; ///< in world space, of length 1
    float radius = 0.0f;                  ///< of the sphere round the next joint that hits colliders, at least 0
};

/// A sphere or capsule that spring joints do not enter.
struct SpringCollider
{
    std::string joint;             ///< the name of the joint that carries it
    osg::Vec3 center;              ///< in the joint's space
    std::optional<osg::Vec3> tail; ///< the other end of a capsule, in the joint's space; empty: a sphere
    float radius = 0.0f;           ///< in the units of the set's file, at least 0
};

/// A tail, a lock of hair or the hem of a coat.
struct SpringChain
{
    /// From the root to the tip, each a descendant of the one before it. The last joint only gives the length of the
    /// one before it and does not turn.
    std::vector<SpringJoint> joints;
    std::vector<std::size_t> colliders; ///< indices of the colliders that the chain hits
};

} // namespace osgGpuAnimation
