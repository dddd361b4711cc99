// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/lod/LodLevels.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <memory>

namespace osgGpuAnimation
{

/// What the kit's own code and plugins need of a SkinnedGeometry, and applications do not: its levels of detail.
struct MeshDetail
{
    /// The levels, see CharacterMeshes::setPixelError(). The first call creates them from poses of the set.
    static std::shared_ptr<const LodLevels> levels(const SkinnedGeometry& mesh, const AnimationSet& set);
    /// The same without creating any. Null: not created, or the mesh has changed.
    static std::shared_ptr<const LodLevels> findLevels(const SkinnedGeometry& mesh) { return mesh._lod->known(mesh); }
    /// levels: of this mesh, see LodLevels::restored().
    static void setLevels(SkinnedGeometry& mesh, std::shared_ptr<const LodLevels> levels)
    {
        mesh._lod->set(std::move(levels));
    }
    /// For example after a change of the clips; levels() creates new ones.
    static void forgetLevels(SkinnedGeometry& mesh) { mesh._lod->forget(); }
};

} // namespace osgGpuAnimation
