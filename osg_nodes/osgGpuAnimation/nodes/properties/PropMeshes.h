// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/Outfit.h>

#include <vector>

namespace osgGpuAnimation
{

/// The geometries below a prop's node as rigid meshes on the palette entry of its joint, with the kit's program and the
/// state of the nodes above them. Arrays that need no transform are shared.
/// Errors: no node; no such joint; a joint that no palette entry follows; a matrix that is not affine, mirrors or has
/// no inverse; no osg::Geometry with osg::Vec3Array vertices, as in animated models.
Result<std::vector<osg::ref_ptr<SkinnedGeometry>>> propMeshes(const Outfit::Prop& prop, const AnimationSet& set);

} // namespace osgGpuAnimation
