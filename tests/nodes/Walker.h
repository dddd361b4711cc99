// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <memory>

namespace osgGpuAnimation
{

/// A person of 1.7 m in metres, in the axes of a glTF file: it walks towards +Z with 1.1 m a second in the clip "Walk"
/// (0.9 s), with flat soles at height 0 until the heels lift, and stands in "Stand". Joints: "hips", "thigh.L",
/// "shank.L", "foot.L" (the ankle), "toes.L" (the ball of the foot), "….R", "head". Constraints: "left" and "right",
/// the legs, and the look-at "head".
struct Walker
{
    static constexpr double seconds = 0.9;  ///< of a round of "Walk"
    static constexpr double speed = 1.1;    ///< metres a second
    static constexpr double duty = 0.6;     ///< share of a round that a foot is planted, from phase 0 (left) or 0.5 on
    static constexpr double heelOff = 0.42; ///< phase of a foot at which its heel lifts

    static std::shared_ptr<const AnimationSet> makeSet();
    /// A character of the set, +Z up; it walks towards -Y. It has no meshes.
    static osg::ref_ptr<AnimatedCharacter> make();
};

} // namespace osgGpuAnimation
