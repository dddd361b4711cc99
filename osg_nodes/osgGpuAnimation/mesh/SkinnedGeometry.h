// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/mesh/MorphTarget.h>

#include <osg/Geometry>
#include <osg/TextureBuffer>
#include <osgUtil/CullVisitor>

#include <atomic>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

class MeshLod;
struct MorphDeltas;
struct PalettePlace;

/// A mesh drawn from the palette: vertex arrays in bind pose and, per vertex, the palette entries that move it with
/// their weights. A mesh belongs to no character: it serves all instances of a set, and the AnimatedCharacter above it
/// selects the palette during cull.
///
///     osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
///     mesh->setVertexArray(positions);
///     mesh->setInfluences(0, entries, weights);   // osg::Vec4usArray, osg::Vec4Array: one element per vertex
///     mesh->setStateSet(material);                // with characterProgram() or another program with skin.glsl
///     character->addChild(mesh);
///
/// Meshes use vertex buffers, never display lists. The bounding box covers all clips of the set, see
/// AnimatedCharacter::computeClipBounds().
class SkinnedGeometry : public osg::Geometry
{
public:
    /// An empty mesh with vertex buffers and a vertex array object.
    SkinnedGeometry();
    /// Shares the arrays, morph targets and levels of detail.
    SkinnedGeometry(const SkinnedGeometry& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGpuAnimation, SkinnedGeometry)
    /// Visits the mesh as a Drawable, not as a Geometry: visitors that merge geometries or reorder and transform
    /// vertices (the Optimizer) would separate vertices from palette entries and morph targets. Below a
    /// PosedMeshSource, intersectors test the posed mesh, but their hits name this drawable. Writers of other file
    /// formats visit the posed mesh instead.
    void accept(osg::NodeVisitor& visitor) override;
    /// Adds the visible mesh to the visitor's render bin. toEye: from the space of the instances' placements to the
    /// eye. depth: distance from the eye, for sorting.
    void addTo(osgUtil::CullVisitor& visitor, osg::RefMatrix* toEye, float depth);
    /// The initial bound: the vertices are in bind pose and in the file's axes. Without one, the box of the vertices.
    osg::BoundingBox computeBoundingBox() const override;
    /// Null: hides the vertex arrays from OSG's tools, see accept().
    osg::Geometry* asGeometry() override { return nullptr; }
    const osg::Geometry* asGeometry() const override { return nullptr; }

    static constexpr unsigned int maxInfluenceSets = 2; ///< of four influences each

    /// Sets four influences per vertex: set 0 is required, set 1 optional.
    /// entries: palette entries (AnimationSet::entryOfSkin, entryOfRigidJoint), each below the set's palette size.
    /// weights: as in the file; entries with weight 0 are ignored. Both: one element per vertex.
    void setInfluences(unsigned int influenceSet, osg::Vec4usArray* entries, osg::Vec4Array* weights);
    const osg::Vec4usArray* getEntries(unsigned int influenceSet) const; ///< null: the set is not used
    const osg::Vec4Array* getWeights(unsigned int influenceSet) const;   ///< null: the set is not used

    /// The largest number of influences of a vertex, in [1, 8].
    int getInfluenceCount() const { return _influences; }

    /// Moves all vertices with one palette entry, for a rigid mesh on a joint. Replaces the influences.
    void setRigidEntry(unsigned short entry);
    int getRigidEntry() const { return _rigidEntry; } ///< -1: influences are per vertex

    /// Sets the morph targets in the order of their weights. Call it after the vertices are set.
    /// morph: index of the set's morph weights. targets: arrays with one element per vertex; empty: removes all
    /// targets.
    void setMorphTargets(const AnimationSet& set, std::size_t morph, std::vector<MorphTarget> targets);
    /// The same before the set is known. entry: the set's entryOfMorph(morph).
    void setMorphTargets(int morph, int entry, std::vector<MorphTarget> targets);
    /// The targets as set, in the order of their weights.
    const std::vector<MorphTarget>& getMorphTargets() const { return _morphTargets; }
    /// The packed targets for the shader. Meshes with the same target arrays share it. Null: no targets.
    const osg::TextureBuffer* getMorphDeltas() const;
    int getMorph() const { return _morph; }           ///< index of the set's morph weights; -1: none
    int getMorphEntry() const { return _morphEntry; } ///< the first palette entry of the weights; -1: none

    /// The source of vertex colours.
    enum class Colors
    {
        White,   ///< no colours
        Array,   ///< the colour array, to which morph targets may add
        Targets, ///< white plus morph targets
    };
    Colors getColors() const; ///< from the colour array and the morph targets
    /// The shader defines of every draw of this mesh, besides its StateSet's: POSE_SKINNED and, with colours,
    /// POSE_COLORED. Null: the StateSet's are enough, as without colours after applySkinDefines().
    osg::StateSet* meshState() const;

    /// The number of elements of the vertex array; 0 without one.
    std::size_t getVertexCount() const { return getVertexArray() ? getVertexArray()->getNumElements() : 0; }

    /// function(std::size_t entry, float weight), for each palette entry that moves the vertex.
    template <typename Function>
    void forEachInfluence(std::size_t vertex, Function function) const;

    /// The CPU twin of skin.glsl, in double precision: computes the vertex positions in the character's own space.
    /// palette: the set's paletteSize() entries of one instance. outPositions: one per vertex.
    void computePositions(const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& outPositions) const;
    /// The same for the normals: one per vertex, not normalized. Empty without an osg::Vec3Array of as many normals.
    void computeNormals(const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& outNormals) const;

    /// Sets the palette's uniforms in the applied program and draws all instances of the PaletteBinding.
    void drawImplementation(osg::RenderInfo& renderInfo) const override;
    osg::VertexArrayState* createVertexArrayStateImplementation(osg::RenderInfo& renderInfo) const override;
    void compileGLObjects(osg::RenderInfo& renderInfo) const override;
    void releaseGLObjects(osg::State* state = nullptr) const override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    /// Does nothing: a transform of the vertices, such as the Optimizer's, would break the bind pose.
    void accept(osg::Drawable::AttributeFunctor&) override {}
    using osg::Geometry::accept;

protected:
    ~SkinnedGeometry() override;

private:
    friend struct MeshDetail;

    void drawPrimitives(osg::State& state, int count, int level) const;
    void bindPalette(osg::State& state, const PalettePlace& place) const;

    int _influences = 1;  ///< the largest number per vertex
    int _rigidEntry = -1; ///< the entry that moves all vertices; -1: influences are per vertex
    std::vector<MorphTarget> _morphTargets;
    std::unique_ptr<MorphDeltas> _morphDeltas; ///< never null
    mutable std::atomic<bool> _isMorphLimitReported{false};
    int _morph = -1;
    int _morphEntry = -1;          ///< the first palette entry of the weights
    std::unique_ptr<MeshLod> _lod; ///< never null
};

template <typename Function>
void SkinnedGeometry::forEachInfluence(std::size_t vertex, Function function) const
{
    if (_rigidEntry >= 0) function(static_cast<std::size_t>(_rigidEntry), 1.0f);
    for (unsigned int influenceSet = 0; influenceSet < maxInfluenceSets; ++influenceSet)
    {
        const osg::Vec4usArray* vertexEntries = getEntries(influenceSet);
        const osg::Vec4Array* vertexWeights = getWeights(influenceSet);
        if (!vertexEntries || !vertexWeights) continue;
        if (vertex >= vertexEntries->size() || vertex >= vertexWeights->size()) continue;
        for (int i = 0; i < 4; ++i)
            if ((*vertexWeights)[vertex][i] != 0.0f) function((*vertexEntries)[vertex][i], (*vertexWeights)[vertex][i]);
    }
}

} // namespace osgGpuAnimation
