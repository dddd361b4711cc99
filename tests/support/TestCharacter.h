// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

namespace osgGpuAnimation
{

/// A character that tests can predict: a white square of 1 unit (in the XZ plane, its lower left corner at the origin)
/// hangs on joint "tip", child of joint "base", as is "side", 2 units along +X. Clips: "shift" moves base along +X from
/// 0 to 2 in 2 seconds, linearly; "turn" turns base about +Y by a quarter in 1 second. Playing "shift" at time 0,
/// stopped clocks.
osg::ref_ptr<AnimatedCharacter> makeTestCharacter();

/// Such a square on joint 1, "tip", or 2, "side".
osg::ref_ptr<SkinnedGeometry> makeTestSquare(int joint);

/// The set of the character above; the same one at each call.
std::shared_ptr<const AnimationSet> testCharacterSet();

} // namespace osgGpuAnimation
