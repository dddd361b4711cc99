// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/PosePalette.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/frame/PaletteBinding.h>

#include <osg/Geometry>
#include <osg/PrimitiveSet>
#include <osg/State>
#include <osg/VertexArrayState>

#include <cstddef>

namespace osgGpuAnimation
{

/// While a mesh is drawn: the record of vertex arrays it may use. A mesh has a vertex array object for each OSG context
/// number, but contexts that share GL objects, and with them the number, do not share those. There the mesh is drawn
/// with the context's own record, as geometries without such objects are.
class MeshVertexArrays
{
public:
    explicit MeshVertexArrays(osg::State& state);
    ~MeshVertexArrays();
    MeshVertexArrays(const MeshVertexArrays&) = delete;
    MeshVertexArrays& operator=(const MeshVertexArrays&) = delete;

    /// Several contexts have the state's number.
    static bool isNumberShared(const osg::State& state);
    /// Makes it a record without a vertex array object. The context it was made in is current.
    static void removeObject(osg::VertexArrayState& arrays);

private:
    osg::State& _state;
    bool _isContextsOwn;
};

/// Sets the uniforms by which skin.glsl finds the palette and the tints in the program that is applied.
/// influences: of a vertex, at most. rigidEntry: the entry that moves all vertices; -1: influences are per vertex.
void bindPalette(osg::State& state, const PalettePlace& place, int influences, int rigidEntry);

/// While a mesh of several placed characters is drawn: tells the program where they stand. A program that cannot be
/// told (it does not link skin.glsl) is given one after another, by the model-view matrix.
class InstancedDraw
{
public:
    /// Placements that one draw can take, and where their palettes are.
    struct Run
    {
        PalettePlace place; ///< texture 0: nowhere
        std::size_t count = 0;
    };

    InstancedDraw(osg::State& state, const PaletteBinding& binding);
    ~InstancedDraw();
    InstancedDraw(const InstancedDraw&) = delete;
    InstancedDraw& operator=(const InstancedDraw&) = delete;

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

/// Draws the primitives so many times, with gl_InstanceID from 0 to count - 1, whatever number of instances they name
/// themselves. To be called where a drawable draws its primitives, its vertex arrays being set up. Primitive sets of
/// the indirect kinds, whose counts lie on the GPU, are drawn once, as they are.
/// usesBuffers: whether indices lie in buffer objects.
void drawInstanced(osg::State& state, const osg::PrimitiveSet& primitives, int count, bool usesBuffers);

} // namespace osgGpuAnimation
