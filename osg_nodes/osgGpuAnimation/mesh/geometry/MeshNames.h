// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Group>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Names a drawable after the node of the file that shows it. The name is a user value, so that OSG's own serializers
/// store it and copies share it; the drawable's own name is that of the file's mesh. Empty or equal to that: no value.
void setNodeName(osg::Object& mesh, const std::string& name);
/// The drawable's own name if no node's name is known.
std::string nodeNameOf(const osg::Object& mesh);

/// The meshes of the group (see forEachMesh()) of that node's name; if there are none, those of that mesh's name.
/// Error: there are none; the message lists the nodes' names.
Result<std::vector<SkinnedGeometry*>> meshesNamed(const osg::Group& group, const std::string& name);

} // namespace osgGpuAnimation
