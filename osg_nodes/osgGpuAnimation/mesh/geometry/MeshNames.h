// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Group>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Stores the name of the file's mesh where the drawable has another name: names in the graph are those of the file's
/// nodes. It is a user value, so that OSG's own serializers store it and copies share it.
void setMeshName(osg::Object& drawable, const std::string& name);
/// The name of the file's mesh; the drawable's own name if no other is stored.
std::string meshNameOf(const osg::Object& drawable);

/// The meshes of the group (see forEachMesh()) of that name; if there are none, those whose mesh in the file has it.
/// Error: there are none; the message lists the names of the first kind.
Result<std::vector<SkinnedGeometry*>> meshesNamed(const osg::Group& group, const std::string& name);

/// The names of the group's material variants in the file's order, then of those of its meshes, as of garments.
std::vector<std::string> variantNamesIn(const osg::Group& group);

} // namespace osgGpuAnimation
