// SPDX-License-Identifier: MIT
#pragma once

#include "../Binding.h"
#include "../Rig.h"

namespace osgGpuAnimation::scenes
{

// The serpent lies along the Z axis, its head towards +Z; a place on it is told by its distance from the neck,
// metres, negative on the head.
constexpr int serpentSegments = 40;
constexpr double serpentLength = 2.6;  ///< metres from the neck's joint to the tip of the tail
constexpr double serpentHeight = 0.75; ///< metres above the ground
constexpr double serpentNeck = 1.10;   ///< the neck's place on the Z axis

/// Neck first, each segment the child of the one before; Head and Jaw hang on the neck.
Rig makeSerpentRig();
/// The segment at a distance from the neck, softly blended with its neighbours; on the head, the head's joint.
Binding serpentBindingAt(const Rig& rig, double distance);

} // namespace osgGpuAnimation::scenes
