// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <memory>
#include <string>

namespace osgGpuAnimation
{

/// What of a joint's motion is taken out of the clips of a set, to move the whole character instead.
struct RootMotionAxes
{
    bool horizontal = true;       ///< across the up axis
    bool vertical = false;        ///< along it
    bool yaw = false;             ///< turning about it
    glm::dvec3 up{0.0, 1.0, 0.0}; ///< of the set's model: glTF's is +Y. Need not be unit
};

/// The set with every clip's motion of the joint taken out: what is left stays where the clip's first keyframe is, and
/// AnimationController::takeRootMotion() hands over the rest. The keyframes of all clips are copied.
///
///     auto set = withRootMotion(fox->set(), "hips", {true, false, true});
///     if (set) fox->setAnimationSet(set.value());
///
/// At keyframes, and between them as long as yaw is not taken out, motion and what is left make up the very same pose
/// as before; with yaw they differ between keyframes as the arc from its chord.
/// Errors: no such joint; a clip whose root motion was taken out before (its motion would be lost: begin with the set
/// as it was); an up axis of no length or not finite; a clip that moves a joint above this one; a joint under a
/// transform that is not rotation, translation and uniform scale (what is left could not be written as one).
Result<std::shared_ptr<const AnimationSet>> withRootMotion(const AnimationSet& set, const std::string& joint,
                                                           const RootMotionAxes& axes = {});

} // namespace osgGpuAnimation
