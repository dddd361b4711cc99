// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/PosePalette.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

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
/// For the next draws, after bindPalette(): see LodLevels::Step.
void setOutset(osg::State& state, float outset);

/// RAII: the instances of a PaletteBinding for the draws of one mesh, as runs that one draw each shows. Where their
/// placements come from:
/// - consecutive instances of the batch: the palette has them;
/// - instances of a list: buffer textures, with the placements of all instances of the crowd if they share poses;
/// - characters that are drawn together: vertex attributes with a divisor (faster in llvmpipe than a fetch by index).
///   Programs that do not link skin.glsl get one draw per character, with its placement in the model-view matrix.
class InstanceRuns
{
public:
    /// Instances with one palette.
    struct Run
    {
        PalettePlace place; ///< for bindPalette(); texture 0: no palette
        std::size_t count = 0;
    };

    InstanceRuns(osg::State& state, const PosePipeline& pipeline, const PaletteBinding& binding);
    ~InstanceRuns();
    InstanceRuns(const InstanceRuns&) = delete;
    InstanceRuns& operator=(const InstanceRuns&) = delete;

    /// False: the applied program does not skin, so it has to draw each instance by itself, see moveAsOnePiece().
    bool isSkinned() const { return _isSkinned; }
    /// For a program that does not skin: moves all vertices of an instance by one matrix to the space of its joints'
    /// roots, from there by the instance's root matrix and placement, all in the model-view matrix.
    void moveAsOnePiece(const AffineMatrix& meshToRoots) { _meshToRoots = toOsg(meshToRoots); }

    /// The longest run that starts with the drawn instance of that number.
    Run at(std::size_t first) const;
    /// Binds the placements before the draw of the run that starts there, after bindPalette(). The mesh's vertex arrays
    /// must be set up.
    void use(std::size_t first) const;

    /// True if the mesh has vertex arrays at the locations of placements.
    static bool isRefusedBy(const osg::Geometry& mesh);

private:
    void findPlaced();
    Run runOfBatch(std::size_t first) const;
    Run runOfTransforms(std::size_t first) const;
    void usePlaced() const;
    void useTransforms(std::size_t first) const;
    void usePiece(std::size_t first) const;

    osg::State& _state;
    const PosePipeline& _pipeline;
    const PaletteBinding& _binding;
    Run _placed; ///< of a list
    PlacedInstanceBuffers::Textures _textures;
    const InstanceTransformBuffers::Joined* _transforms = nullptr; ///< null: the binding has no placements
    bool _areAttributes = false; ///< true: the program reads the placements; false: one draw per character
    bool _isSkinned = true;
    bool _isDrawn = true;
    osg::Matrixd _view; ///< the draw's own model-view matrix
    osg::Matrixd _meshToRoots;
};

/// Draws `count` instances of the primitives (gl_InstanceID in [0, count)) and ignores their own number of instances.
/// The vertex arrays must be set up. Indirect primitive sets, whose counts are on the GPU, are drawn once, unchanged.
/// usesBuffers: true if indices are in buffer objects.
void drawInstanced(osg::State& state, const osg::PrimitiveSet& primitives, int count, bool usesBuffers);

} // namespace osgGpuAnimation
