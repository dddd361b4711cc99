// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/characters/CharacterDraws.h>

#include <osg/NodeVisitor>

namespace osgGpuAnimation
{

/// Prepares a character for its first frame. In a compile traversal of OSG (osgUtil::GLObjectsVisitor, or the
/// osgUtil::IncrementalCompileOperation of a DatabasePager) it uploads the animation set, evaluates a pose, and draws
/// the meshes once without rasterization, with the state sets on the visitor's path and a headlight. The first frame
/// then compiles and links no program, and the driver has translated the programs for the vertex arrays and the state.
/// A second character of the same set prepares the instanced draw, which several characters share. Nothing is drawn
/// below nodes that add state when they are culled (effects, shadows, surroundings, cull callbacks) and where lights of
/// the scene are on: the programs would be others.
///
/// Call it in the node's traversal, after its children. With any other visitor it does nothing.
void prepareFirstDraw(osg::NodeVisitor& visitor, const DrawnCharacter& character);

} // namespace osgGpuAnimation
