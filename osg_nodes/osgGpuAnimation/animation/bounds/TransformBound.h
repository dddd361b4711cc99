// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// An upper bound for the lengths that an affine matrix, or any matrix of a set, produces. A product of factors that
/// are finite in float may be infinite: the bounds multiply in double, which detects every overflow.
struct TransformBound
{
    /// The limit for drawing and playing: the square of a length must fit a float (OSG's bounding spheres).
    static constexpr double maxNumber = 1e18;

    double stretch = 1.0;  ///< the largest length of a transformed vector of length 1
    double distance = 0.0; ///< the largest distance of the transformed origin

    static TransformBound of(const glm::dmat4& matrix);
    static TransformBound of(const JointTransform& transform);
    /// Applies the inner bound first.
    TransformBound operator*(const TransformBound& inner) const;
    void add(const TransformBound& other);
    /// The largest distance from the origin of a transformed point that was within the radius.
    double of(double radius) const { return stretch * radius + distance; }
    bool fits() const { return stretch <= maxNumber && distance <= maxNumber; } ///< false for NaN
};

/// One per joint, from the joint to the model: at rest, or at all times of the clip.
std::vector<TransformBound> boundsAtRest(const Skeleton& skeleton);
std::vector<TransformBound> boundsOfClip(const Skeleton& skeleton, const Clip& clip);

/// True if all joints at all times of the clip, and all its numbers, are within `maxNumber`.
bool fits(const Skeleton& skeleton, const Clip& clip);

/// The end of messages about transforms that are too large.
std::string outOfRangeText();

/// One per palette entry, over the rest pose and all clips; 0 for entries of weights.
std::vector<TransformBound> boundsOfEntries(const AnimationSet& set);

/// True if the shaders compute finite palettes of the set without limiting products (see POSE_LARGEST_NUMBER), in all
/// mixes of its rest pose and clips, with root matrices of numbers up to `maxNumber`. Posed joints and additive layers
/// are not part of it. Reads all keyframes.
bool hasModestPalette(const AnimationSet& set);

} // namespace osgGpuAnimation
