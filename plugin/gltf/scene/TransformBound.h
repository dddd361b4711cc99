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

/// An upper bound of what an affine matrix, or any matrix of a set, does to lengths. Each factor of a product may be
/// finite in float and the product infinite: the bounds multiply in double, where no overflow stays unnoticed.
struct TransformBound
{
    /// Nothing farther out is drawn or played: the square of a length must fit a float (OSG's bounding spheres).
    static constexpr double farthest = 1e18;

    double stretch = 1.0;  ///< the largest length that a vector of length 1 gets
    double distance = 0.0; ///< the largest distance that the origin moves

    static TransformBound of(const glm::dmat4& matrix);
    /// Applies the inner bound first.
    TransformBound operator*(const TransformBound& inner) const;
    void add(const TransformBound& other);
    /// The largest distance of a transformed point whose own distance is at most the radius.
    double of(double radius) const { return stretch * radius + distance; }
    bool fits() const { return stretch <= farthest && distance <= farthest; } ///< false for NaN
};

/// One a joint, from the joint to the model: at rest, or at all times of the clip.
std::vector<TransformBound> boundsAtRest(const Skeleton& skeleton);
std::vector<TransformBound> boundsOfClip(const Skeleton& skeleton, const Clip& clip);

/// True if all joints stay near enough at all times of the clip, and all its numbers are small enough.
bool fits(const Skeleton& skeleton, const Clip& clip);

/// The end of messages about transforms that are too large.
std::string beyondFarthest();

/// The largest distance of the points from the origin; infinite for NaN.
double radiusOf(const osg::Vec3Array& points);

/// One a palette entry, over the rest pose and all clips; 0 for entries of weights.
std::vector<TransformBound> boundsOfEntries(const AnimationSet& set);

} // namespace osgGpuAnimation::gltf
