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
    /// The levels, see CharacterMeshes::setPixelError(). Null: there are none yet, or the mesh has changed.
    static std::shared_ptr<const LodLevels> findLevels(const SkinnedGeometry& mesh) { return mesh._lod->known(mesh); }
    /// levels: of this mesh, see LodLevels::restored().
    static void setLevels(SkinnedGeometry& mesh, std::shared_ptr<const LodLevels> levels)
    {
        mesh._lod->set(std::move(levels));
    }
    /// A copy for another thread, which may read it while the application changes the mesh: of what levels are made
    /// from, without its StateSet, callbacks and user data.
    static osg::ref_ptr<const SkinnedGeometry> snapshot(const SkinnedGeometry& mesh);
    static unsigned int forgetCount(const SkinnedGeometry& mesh) { return mesh._lod->forgetCount(); }
    /// For example after a change of the clips.
    static void forgetLevels(SkinnedGeometry& mesh) { mesh._lod->forget(); }
};

} // namespace osgGpuAnimation
