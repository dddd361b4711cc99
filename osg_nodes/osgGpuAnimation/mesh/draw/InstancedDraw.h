// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/PosePalette.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>

#include <osg/Geometry>
#include <osg/PrimitiveSet>
#include <osg/State>
#include <osg/VertexArrayState>

#include <cstddef>

namespace osgGpuAnimation
{

/// RAII: selects the vertex array record for a mesh's draw. OSG stores one vertex array object per context number, but
/// contexts that share GL objects, and therefore the number, cannot share vertex array objects. In such contexts the
/// mesh uses the context's global record, like geometries without vertex array objects.
class MeshVertexArrays
{
public:
    explicit MeshVertexArrays(osg::State& state);
    ~MeshVertexArrays();
    MeshVertexArrays(const MeshVertexArrays&) = delete;
    MeshVertexArrays& operator=(const MeshVertexArrays&) = delete;

    /// True if several contexts have the state's number.
    static bool isNumberShared(const osg::State& state);
    /// Deletes the record's vertex array object. Its context must be current.
    static void removeObject(osg::VertexArrayState& arrays);

private:
    osg::State& _state;
    bool _isContextsOwn;
};

/// Binds the palette and the tints and sets the uniforms of skin.glsl in the applied program.
/// influences: the largest number per vertex. rigidEntry: moves all vertices; -1: influences are per vertex.
void bindPalette(osg::State& state, const PalettePlace& place, int influences, int rigidEntry);
/// For the next draws, after bindPalette(): see LodLevels::Reduced.
void setOutset(osg::State& state, float outset);

/// The draw of instances with shared poses: the list of the drawn instances and the placements of all.
class PlacedDraw
{
public:
    PlacedDraw(osg::State& state, const PosePipeline& pipeline, const PaletteBinding& binding);

    /// For bindPalette(), from the first drawn instance on. Its texture is 0 if a buffer texture of the context cannot
    /// hold the placements or the poses.
    const PalettePlace& place() const { return _place; }
    /// Binds the list and the placements and sets their uniforms, after bindPalette().
    void use() const;

private:
    osg::State& _state;
    PalettePlace _place;
    PlacedInstanceBuffers::Textures _textures;
};

/// RAII: passes the placements of several characters to the program for the draws of one mesh. Programs that do not
/// link skin.glsl get one draw per character, with its placement in the model-view matrix.
class InstancedDraw
{
public:
    /// The placements of one draw and their palette.
    struct Run
    {
        PalettePlace place; ///< texture 0: no palette
        std::size_t count = 0;
    };

    InstancedDraw(osg::State& state, const PaletteBinding& binding);
    ~InstancedDraw();
    InstancedDraw(const InstancedDraw&) = delete;
    InstancedDraw& operator=(const InstancedDraw&) = delete;

    /// The longest run that starts with that placement.
    Run run(const PosePipeline& pipeline, std::size_t first) const;
    /// Binds the placements before the draw of the run that starts there. The mesh's vertex arrays must be set up.
    void use(std::size_t first) const;

    /// True if the mesh has vertex arrays at the locations of placements.
    static bool isRefusedBy(const osg::Geometry& mesh);

private:
    osg::State& _state;
    const PaletteBinding& _binding;
    const BufferTexture* _transforms = nullptr; ///< null: one draw per character
};

/// Draws `count` instances of the primitives (gl_InstanceID in [0, count)) and ignores their own number of instances.
/// The vertex arrays must be set up. Indirect primitive sets, whose counts are on the GPU, are drawn once, unchanged.
/// usesBuffers: true if indices are in buffer objects.
void drawInstanced(osg::State& state, const osg::PrimitiveSet& primitives, int count, bool usesBuffers);

} // namespace osgGpuAnimation
