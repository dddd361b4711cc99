// SPDX-License-Identifier: MIT
#pragma once

#include <osg/BoundingBox>
#include <osg/Group>
#include <osg/Vec3d>

#include <vector>

namespace osgGpuAnimation
{

/// The box around the children in the group's space: of characters and crowds, the box of what they play now (see
/// AnimatedCharacter::getCurrentBounds). Invalid if nothing is drawn below.
osg::BoundingBoxd extentOf(osg::Group& group);

/// Points around everything below the group, in the group's space: the vertices of characters in their present pose,
/// which the CPU twin computes (boxes of clips are up to a tenth larger), the vertices of other meshes, and of a crowd
/// those of its outermost instances. Empty if nothing is drawn below.
/// poseCount: of each character, spread over the clip that plays now, from the present pose on; of crowds at most
/// three.
std::vector<osg::Vec3d> pointsOf(osg::Group& group, int poseCount = 1);

} // namespace osgGpuAnimation
