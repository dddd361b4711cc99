// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

namespace osgGpuAnimation
{

/// A character with predictable pictures: a white square of 1 unit (in the XZ plane, its lower left corner at the
/// origin) follows joint "tip". "tip" and "side", 2 units along +X, are children of joint "base". Clips: "shift" moves
/// base along +X from 0 to 2 in 2 seconds, linearly; "turn" turns base about +Y by 90 degrees in 1 second. The
/// character plays "shift" from time 0.
osg::ref_ptr<AnimatedCharacter> makeTestCharacter();

/// Such a square that follows joint 1, "tip", or 2, "side".
osg::ref_ptr<SkinnedGeometry> makeTestSquare(int joint);

/// The set of the character above; the same one at each call.
std::shared_ptr<const AnimationSet> testCharacterSet();

} // namespace osgGpuAnimation
