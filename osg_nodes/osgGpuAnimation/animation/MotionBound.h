// SPDX-License-Identifier: MIT
#pragma once

#include "TrackMix.h"

namespace osgGpuAnimation
{

/// How far a joint's translation, rotation and scale can go and how fast they can change between two keyframes: upper
/// bounds of the norms of the values and their first two derivatives, the interval being [0, 1].
struct TrackMotion
{
    double shift = 0.0, shift1 = 0.0, shift2 = 0.0; ///< translation
    double size = 0.0, size1 = 0.0, size2 = 0.0;    ///< scale: of the largest component
    double turn1 = 0.0, turn2 = 0.0;                ///< rotation matrix; infinite where a spline may pass through 0

    /// alpha of the keyframes plays no part.
    static TrackMotion between(const KeyframePair& keyframes, std::size_t track);
};

/// The same for a joint's whole way to the model's space: v -> A v + c. Found from root to leaf by the product rule.
struct ChainMotion
{
    double linear = 1.0, linear1 = 0.0, linear2 = 0.0; ///< A's operator norm and those of its derivatives
    double origin = 0.0, origin2 = 0.0;                ///< |c| and |c''|

    ChainMotion child(const TrackMotion& motion) const;

    /// How far from the root a point within this distance of the joint's origin can be.
    double reach(double radius) const { return origin + linear * radius; }
    /// How far such a point can stray from the straight line between its two ends: |p''| / 8.
    double strayed(double radius) const { return (origin2 + linear2 * radius) / 8.0; }
};

} // namespace osgGpuAnimation
