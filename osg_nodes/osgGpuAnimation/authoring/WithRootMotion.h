// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Result.h>

#include <glm/vec3.hpp>

#include <memory>
#include <string>

namespace osgGpuAnimation
{

/// The parts of a joint's motion that withRootMotion() removes from the clips, to move the whole character instead.
struct RootMotionAxes
{
    bool horizontal = true;       ///< translation perpendicular to the up axis
    bool vertical = false;        ///< translation along it
    bool yaw = false;             ///< rotation about it
    glm::dvec3 up{0.0, 1.0, 0.0}; ///< in model space, +Y in glTF; need not be unit
};

/// Removes a joint's motion from every clip of a set; AnimationController::takeRootMotion() returns the removed motion.
/// The joint stays where it is in the first keyframe of each clip. The new set has copies of all keyframes.
///
///     auto set = withRootMotion(fox->getAnimationSet(), "hips", {true, false, true});
///     if (set) fox->setAnimationSet(set.value());
///
/// Root motion and remaining clip together give the original pose, exactly at keyframes and, without yaw, between them.
/// With yaw they differ between keyframes as an arc differs from its chord.
/// Errors: no such joint; a clip whose root motion was removed before (start from the original set); an up axis of
/// length 0 or not finite; a clip that moves an ancestor of the joint; a joint below a transform that is not a
/// rotation, a translation and a uniform scale.
Result<std::shared_ptr<const AnimationSet>> withRootMotion(const AnimationSet& set, const std::string& joint,
                                                           const RootMotionAxes& axes = {});

} // namespace osgGpuAnimation
