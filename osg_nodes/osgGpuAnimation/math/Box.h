// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/JointTransform.h>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace osgGpuAnimation
{

/// An axis-aligned box. Default: empty (min > max).
struct Box
{
    glm::vec3 min{1e30f};  ///< the least coordinates
    glm::vec3 max{-1e30f}; ///< the largest coordinates

    bool empty() const { return min.x > max.x; } ///< True without a point.
    void add(const glm::vec3& point);            ///< grows to contain the point
    void add(const Box& box);                    ///< grows to contain the box
    void grow(float margin);                     ///< moves every face outwards by margin; an empty box stays empty
    glm::vec3 corner(int i) const;               ///< i: in [0, 8); bit 0 selects max.x, bit 1 max.y, bit 2 max.z
};

/// The largest absolute component.
double maxComponent(const glm::dvec3& v);

/// An axis-aligned box in double precision that contains only finite numbers. Coordinates are clamped to
/// [-limit, limit], so that a renderer can square the size of the box in single precision. Default: empty (min > max).
struct Aabb3d
{
    static constexpr double limit = 1e18; ///< of each coordinate, above and below 0

    glm::dvec3 min{limit};  ///< the least coordinates
    glm::dvec3 max{-limit}; ///< the largest coordinates

    /// The box around a centre. half: half of each side. A NaN gives the largest box on that axis.
    static Aabb3d about(const glm::dvec3& centre, const glm::dvec3& half);

    bool empty() const { return min.x > max.x; } ///< True without a point.
    double diagonal() const;                     ///< length; 0 if empty
    void add(const Aabb3d& box);                 ///< grows to contain the box
    /// This box with every face moved outwards by margin, but not beyond the ball of that radius around the origin.
    Aabb3d grownWithin(double margin, double radius) const;
    /// The smallest distance between a face of `inner` and the same face of this box. inner: inside this box.
    double slackAround(const Aabb3d& inner) const;
    /// Rounds outwards and adds 1e-5 of the largest coordinate, so that vertices computed in single precision stay
    /// inside.
    Box toBox() const;
};

/// A box after an affine transform: a parallelepiped.
struct TransformedBox
{
    glm::dvec3 centre{0.0};    ///< of the box
    glm::dmat3 halfEdges{0.0}; ///< one column per axis of the original box

    /// box: not empty.
    TransformedBox(const AffineMatrix& transform, const Box& box);
    /// The smallest axis-aligned box around linear · this + offset, with every face moved outwards by margin.
    Aabb3d bounds(const glm::dmat3& linear, const glm::dvec3& offset, double margin = 0.0) const;
};

} // namespace osgGpuAnimation
