// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/PaletteBinding.h>

#include <osg/Geometry>
#include <osg/State>

#include <cstddef>

namespace osgGpuAnimation
{

/// While a mesh of several placed characters is drawn: tells the program where they stand. A program that cannot be
/// told (it does not link skin.glsl) is given one after another, by the model-view matrix.
class PlacedDraw
{
public:
    /// Placements that one draw can take, and where their palettes are.
    struct Run
    {
        PalettePlace place; ///< texture 0: nowhere
        std::size_t count = 0;
    };

    PlacedDraw(osg::State& state, const PaletteBinding& binding);
    ~PlacedDraw();
    PlacedDraw(const PlacedDraw&) = delete;
    PlacedDraw& operator=(const PlacedDraw&) = delete;

    /// The run that begins with the placement of that number.
    Run run(const PosePipeline& pipeline, std::size_t first) const;
    /// To be called before the run that begins there is drawn, with the mesh's vertex arrays set up.
    void use(std::size_t first) const;

    /// Whether the mesh has vertex arrays where placements go.
    static bool isRefusedBy(const osg::Geometry& mesh);

private:
    osg::State& _state;
    const PaletteBinding& _binding;
    const BufferTexture* _placements = nullptr; ///< null: one after another
};

} // namespace osgGpuAnimation
