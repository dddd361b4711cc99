// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Group>

namespace osgGpuAnimation
{

/// Calls a function for every SkinnedGeometry among a group's children.
template <typename Function>
void forEachMesh(const osg::Group& group, Function function)
{
    for (unsigned int child = 0; child < group.getNumChildren(); ++child)
    {
        const auto* mesh = dynamic_cast<const SkinnedGeometry*>(group.getChild(child));
        if (mesh) function(*mesh);
    }
}

} // namespace osgGpuAnimation
