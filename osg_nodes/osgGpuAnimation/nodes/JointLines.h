// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

namespace osgGpuAnimation
{

/// Lines from each joint to its parent, drawn over everything: a child for an AnimatedCharacter of this set. The lines
/// are skinned from the palette like any mesh, so they cost the CPU nothing.
osg::ref_ptr<SkinnedGeometry> makeJointLines(const AnimationSet& set);

/// Adds the joint lines to the character or removes them.
void showJointLines(AnimatedCharacter& character, bool isShown);
/// True if showJointLines() has added lines.
bool hasJointLines(const AnimatedCharacter& character);

} // namespace osgGpuAnimation
