// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <glm/mat4x4.hpp>
#include <osg/Array>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A bound from above for what an affine matrix, or any of many, does to lengths. What each factor of a product says
/// by itself is finite in float and the product may not be: the bounds multiply in double, where nothing overflows
/// unnoticed.
struct Reach
{
    /// Farther out nothing is drawn or played: the square of a length must fit a float (OSG's bounding spheres).
    static constexpr double farthest = 1e18;

    double stretch = 1.0;  ///< the longest that a vector of length 1 becomes
    double distance = 0.0; ///< the farthest that the origin comes to lie

    static Reach of(const glm::dmat4& matrix);
    /// First the inner, then this.
    Reach operator*(const Reach& inner) const;
    void add(const Reach& other);
    /// How far out a point may come to lie that is no farther than the radius.
    double of(double radius) const { return stretch * radius + distance; }
    bool fits() const { return stretch <= farthest && distance <= farthest; } ///< false for NaN
};

/// By joint, from the joint to the model: at rest, or wherever the clip has it.
std::vector<Reach> reachAtRest(const Skeleton& skeleton);
std::vector<Reach> reachOfClip(const Skeleton& skeleton, const Clip& clip);

/// Are all joints within reach at all times of the clip, and all its numbers small enough?
bool fits(const Skeleton& skeleton, const Clip& clip);

/// "beyond what float numbers hold": the message's end, for what is too far out.
std::string beyondFarthest();

/// The farthest of the points from the origin; NaN and infinite ones are infinitely far.
double radiusOf(const osg::Vec3Array& points);

/// By palette entry, over the rest pose and all clips; entries of weights reach nowhere.
std::vector<Reach> reachOfEntries(const AnimationSet& set);

} // namespace osgGpuAnimation::gltf
