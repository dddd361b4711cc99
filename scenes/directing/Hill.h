// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SpringBones.h>

#include <osg/Node>

namespace osgGpuAnimation
{

/// Declares the constraint "look" of a wanderer's chest, neck and head.
Result<void> addLook(AnimatedCharacter& wanderer);
/// Lets a wanderer's scarf and hood swing.
Result<osg::ref_ptr<SpringBones>> addSprings(AnimatedCharacter& wanderer);
/// Plays the blend space from Walk to Run. speed: metres a second, in [0.71, 2.1].
Result<void> playGaits(AnimatedCharacter& wanderer, double speed);
/// Keeps a wanderer's feet on the ground; the constraint "look" is declared, too.
Result<void> addGroundFeet(AnimatedCharacter& wanderer, osg::Node& ground);

/// A wanderer who follows a path over hilly ground, faster and slower, with the feet on the ground and the scarf on
/// springs, and looks at a lantern that flies beside it. model: Wanderer.glb.
Result<osg::ref_ptr<osg::Node>> makeHill(const osg::Node& model);
/// 2,000 wanderers who all look at one bird. model: Wanderer.glb.
Result<osg::ref_ptr<osg::Node>> makeGazers(const osg::Node& model);

} // namespace osgGpuAnimation
