// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

namespace osgGpuAnimation
{

/// makeTestCharacter() with a panel in place of its square: 2 x 2 units in the XZ plane round the joint, facing -Y, of
/// 16 x 16 quads (the fixed pipeline lights vertices), and a back 0.2 units behind; textured, grey material, no shine.
osg::ref_ptr<AnimatedCharacter> makePanelCharacter();

/// The character's current pose, computed by the CPU twin, as plain osg::Geometry for the fixed pipeline. Normals are
/// those of the bind pose.
osg::ref_ptr<osg::Node> makeBaked(const AnimatedCharacter& character);

} // namespace osgGpuAnimation
