// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Bounds.h>

namespace osgGpuAnimation
{

/// A box in double precision that never holds anything but numbers: what is not finite or lies beyond `limit` counts as
/// lying there, so that a renderer can still square the box's size in single precision.
struct SweptBox
{
    static constexpr double limit = 1e18;

    glm::dvec3 min{limit};
    glm::dvec3 max{-limit};

    /// The box of these half sizes about a centre; not a number: everything.
    static SweptBox about(const glm::dvec3& centre, const glm::dvec3& half);

    bool empty() const { return min.x > max.x; }
    double diagonal() const;
    void add(const SweptBox& box);
    /// Grown on every side, but not beyond the ball of that radius about the origin.
    SweptBox grownWithin(double margin, double radius) const;
    /// The least distance from a face of `inner` to the same face of this box that holds it.
    double slackAround(const SweptBox& inner) const;
    /// Rounded outwards, with room for the rounding of those who compute in single precision.
    Box toBox() const;
};

} // namespace osgGpuAnimation
