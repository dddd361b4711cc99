// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>
#include <osgGpuAnimation/math/Box.h>

#include <vector>

namespace osgGpuAnimation
{

/// Upper bounds for a joint between two keyframes: the norms of its translation, scale and rotation matrix and of their
/// first two derivatives over the interval [0, 1].
struct TrackMotion
{
    double shift = 0.0, shift1 = 0.0, shift2 = 0.0; ///< translation
    double size = 0.0, size1 = 0.0, size2 = 0.0;    ///< scale: of the largest component
    double turn1 = 0.0, turn2 = 0.0;                ///< rotation matrix; infinite if a spline may pass through 0

    /// Ignores the alpha of the keyframes.
    static TrackMotion between(const KeyframePair& keyframes, std::size_t track);
};

/// Upper bounds for a joint's transform to model space, v -> A v + c, from root to leaf by the product rule.
struct ChainMotion
{
    double linear = 1.0, linear1 = 0.0, linear2 = 0.0; ///< A's operator norm and those of its derivatives
    double origin = 0.0, origin2 = 0.0;                ///< |c| and |c''|

    ChainMotion child(const TrackMotion& motion) const;

    /// The largest distance from the root of a point within radius of the joint's origin.
    double reach(double radius) const { return origin + linear * radius; }
    /// The largest deviation of such a point from the straight line between its two ends: |p''| / 8.
    double maxDeviation(double radius) const { return (origin2 + linear2 * radius) / 8.0; }
};

/// A box, in model space, that contains every vertex at every time of the clip. The box is conservative: a vertex is a
/// convex combination of its positions under each of its palette entries, and between the sampled times the box grows
/// by a bound on the deviation from a straight line. The box is tight: the sampling rate follows the rotation of the
/// joints. clip: a clip of the set; any other number gives the rest pose. entryBoxes: one box per palette entry.
Box boundsOfClip(const AnimationSet& set, int clip, const EntryBoxes& entryBoxes);

/// The box of the rest pose, then the boxes of all clips: the box of clip c is at index c + 1.
std::vector<Box> boundsOfClips(const AnimationSet& set, const EntryBoxes& entryBoxes);

/// The box of the origins of all joints in the rest pose. Ignores origins beyond Aabb3d::limit.
Box boundsOfJoints(const AnimationSet& set);

} // namespace osgGpuAnimation
