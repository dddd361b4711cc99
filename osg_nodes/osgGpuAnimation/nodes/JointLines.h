// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

namespace osgGpuAnimation
{

/// Lines from each joint to its parent, drawn over everything: to be a child of an AnimatedCharacter of this set. They
/// are skinned as meshes are, from the GPU's palette, so they move with the character at no cost to the CPU.
osg::ref_ptr<SkinnedGeometry> makeJointLines(const AnimationSet& set);

/// Adds the lines to the character, or takes them away again.
void showJointLines(AnimatedCharacter& character, bool isShown);
bool hasJointLines(const AnimatedCharacter& character);

} // namespace osgGpuAnimation
