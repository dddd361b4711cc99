// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Box.h>

namespace osgGpuAnimation
{

/// An axis-aligned box in double precision that contains only finite numbers. Coordinates are clamped to
/// [-limit, limit], so that a renderer can square the size of the box in single precision. Default: empty (min > max).
struct SweptBox
{
    static constexpr double limit = 1e18;

    glm::dvec3 min{limit};
    glm::dvec3 max{-limit};

    /// The box around a centre. half: half of each side. A NaN gives the largest box on that axis.
    static SweptBox about(const glm::dvec3& centre, const glm::dvec3& half);

    bool empty() const { return min.x > max.x; }
    double diagonal() const; ///< 0 if empty
    void add(const SweptBox& box);
    /// This box with every face moved outwards by margin, but not beyond the ball of that radius around the origin.
    SweptBox grownWithin(double margin, double radius) const;
    /// The smallest distance between a face of `inner` and the same face of this box. inner: inside this box.
    double slackAround(const SweptBox& inner) const;
    /// Rounds outwards and adds 1e-5 of the largest coordinate, so that vertices computed in single precision stay
    /// inside.
    Box toBox() const;
};

} // namespace osgGpuAnimation
