// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/Group>

namespace osgGpuAnimation
{

/// The still parts of a character: meshes of its file that do not move. They are plain osg::Geometry nodes beside the
/// character, which OSG draws and culls by its own means. A crowd has no such place, so its still parts are meshes that
/// follow the palette entry of a joint that does not move.
///
/// The character refers to the group of its still parts as a user object, so that clones and stored scenes keep them.
struct StillParts
{
    /// group: beside the character, in the space that getFileToNode() leads to. joint: it carries a rigid mesh
    /// (AnimationSet::rigidJoints()).
    static void set(AnimatedCharacter& character, osg::Group& group, int joint);
    /// The group that was set; null: none.
    static osg::Group* of(const AnimatedCharacter& character);
    /// Adds the still parts as children of the crowd, see RigidMeshes. False: there are none. Warns of those that it
    /// leaves out.
    static bool addTo(osg::Group& crowd, const AnimatedCharacter& character);
};

} // namespace osgGpuAnimation
