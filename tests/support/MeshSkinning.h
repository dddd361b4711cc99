// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/SkinnedGeometryVisitor.h>

#include <ostream>

namespace osgGpuAnimation
{

/// The ways to skin that tests go through; Auto picks one of them.
inline constexpr Skinning skinnings[] = {Skinning::EveryDraw, Skinning::Once};

inline const char* nameOf(Skinning skinning)
{
    return skinning == Skinning::Once ? "Once" : "EveryDraw";
}

inline void PrintTo(Skinning skinning, std::ostream* out)
{
    *out << nameOf(skinning);
}

/// Has all meshes below the node skinned in that way.
inline void setSkinning(osg::Node& node, Skinning skinning)
{
    SkinnedGeometryVisitor visitor([skinning](SkinnedGeometry& mesh) { mesh.setSkinning(skinning); });
    node.accept(visitor);
}

} // namespace osgGpuAnimation
