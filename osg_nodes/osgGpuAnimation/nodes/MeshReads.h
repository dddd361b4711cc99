// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/PaletteBinding.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/SkinningPlan.h>

#include <osg/RenderInfo>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// What one cull visitor hands on to be drawn of skinned meshes in a frame; before any of it is drawn, those of the
/// meshes that are to be skinned once are.
class MeshReads
{
public:
    /// At the beginning of a cull traversal in a graphics context.
    void begin(unsigned int contextId);
    /// The mesh will be drawn for the instances of the binding, which may come later. Returns the state it is to be
    /// drawn with, above its own; null: none.
    osg::StateSet* add(const SkinnedGeometry& mesh, const PaletteBinding& binding);

    /// That state.
    static osg::StateSet* skinnedState(int texels);

    /// On the draw side, when the palettes are there. frame: the PoseFrame's serial number.
    void skin(osg::RenderInfo& renderInfo, std::uint64_t frame);

private:
    struct Read
    {
        osg::ref_ptr<const SkinnedGeometry> mesh;
        osg::ref_ptr<const PaletteBinding> binding;
        bool isOnce;
    };

    std::vector<Read> _reads;
    osg::ref_ptr<SkinningPlan> _plan;
    std::shared_ptr<const SkinningPlan::Meshes> _once;
};

} // namespace osgGpuAnimation
