// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Box.h>

#include <vector>

namespace osgGpuAnimation
{

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
