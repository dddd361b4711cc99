// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/nodes/MorphTarget.h>

#include <osg/Geometry>
#include <osg/TextureBuffer>
#include <osgUtil/CullVisitor>

#include <array>
#include <atomic>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

class LodLevels;
class MeshLod;
class PaletteBinding;
class PosePipeline;
class SkinnedGeometry;
struct MorphDeltas;
struct PalettePlace;

/// A node above SkinnedGeometry that knows its present pose. Intersection visitors that pass the node meet its posed
/// meshes in place of the meshes below it.
class PosedMeshSource
{
public:
    /// The mesh in the present pose, in the node's own space.
    virtual osg::ref_ptr<osg::Geometry> getPosedMesh(const SkinnedGeometry& mesh) const = 0;

protected:
    ~PosedMeshSource() = default;
};

/// A mesh drawn from the palette: ordinary vertex arrays in bind pose and, for each vertex, the palette entries that
/// move it with their weights. It belongs to no character: one mesh serves all instances of a set, and the
/// AnimatedCharacter above it says, while it is culled, whose palette is meant.
///
///     osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
///     mesh->setVertexArray(positions);
///     mesh->setInfluences(0, entries, weights);   // osg::Vec4usArray, osg::Vec4Array: one a vertex
///     mesh->setStateSet(material);                // with characterProgram() or one's own program on skin.glsl
///     character->addChild(mesh);
///
/// Drawn with vertex buffers, never with display lists. The bounding box is the union over all clips of the set, see
/// AnimatedCharacter::computeClipBounds().
class SkinnedGeometry : public osg::Geometry
{
public:
    SkinnedGeometry();
    SkinnedGeometry(const SkinnedGeometry& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGpuAnimation, SkinnedGeometry)
    /// To visitors it is a Drawable, not a Geometry: what merges geometries, reorders or transforms their vertices
    /// (the Optimizer) would part them from their palette entries and morph targets. Intersection visitors that
    /// come through a PosedMeshSource meet its posed mesh instead.
    void accept(osg::NodeVisitor& visitor) override;
    /// Adds the mesh, which is known to be in view, to the visitor's render bin. toEye: the matrix that its instances'
    /// placements refer to. depth: their distance before the eye.
    void addTo(osgUtil::CullVisitor& visitor, osg::RefMatrix* toEye, float depth);
    osg::Geometry* asGeometry() override { return nullptr; }
    const osg::Geometry* asGeometry() const override { return nullptr; }

    static constexpr unsigned int maxInfluenceSets = 2;

    /// Influences of all vertices, four to a set: set 0 is needed, set 1 optional.
    /// entries: palette entries (AnimationSet::entryOfSkin, entryOfRigidJoint), each below the set's palette size.
    /// weights: as the file has them; entries of weight 0 are not looked at.
    void setInfluences(unsigned int influenceSet, osg::Vec4usArray* entries, osg::Vec4Array* weights);
    const osg::Vec4usArray* getEntries(unsigned int influenceSet) const;
    const osg::Vec4Array* getWeights(unsigned int influenceSet) const;

    /// Influences a vertex has, at most: 1 to 8.
    int getInfluenceCount() const { return _influences; }

    /// Every vertex moves with one entry wholly: what a rigid mesh on a joint needs.
    void setRigidEntry(unsigned short entry);
    int getRigidEntry() const { return _rigidEntry; } ///< -1: influences are per vertex

    /// Morph targets, in the order of their weights. morph: which of the set's morph weights moves them. To be called
    /// when the vertices are in; targets' arrays are as long as theirs. No targets: none any more.
    void setMorphTargets(const AnimationSet& set, std::size_t morph, std::vector<MorphTarget> targets);
    /// The same where the set is not known yet. entry: the set's entryOfMorph(morph).
    void setMorphTargets(int morph, int entry, std::vector<MorphTarget> targets);
    const std::vector<MorphTarget>& getMorphTargets() const { return _morphTargets; }
    /// What they are drawn from; meshes whose targets are the same arrays share it. Null: there are none.
    const osg::TextureBuffer* getMorphDeltas() const;
    int getMorph() const { return _morph; }           ///< -1: none
    int getMorphEntry() const { return _morphEntry; } ///< the first palette entry of the weights; -1: none

    /// Where the vertices' colours come from.
    enum class Colors
    {
        White,   ///< they have none
        Array,   ///< to which morph targets may add
        Targets, ///< morph targets add to white
    };
    Colors getColors() const;

    /// Its levels of detail, see AnimatedCharacter::setPixelError(); made when first asked, by the poses of the set.
    std::shared_ptr<const LodLevels> getLodLevels(const AnimationSet& set) const;
    void forgetLodLevels();

    std::size_t getVertexCount() const { return getVertexArray() ? getVertexArray()->getNumElements() : 0; }

    /// function(std::size_t entry, float weight), for each palette entry that moves the vertex.
    template <typename Function>
    void forEachInfluence(std::size_t vertex, Function function) const;

    /// The CPU twin of skin.glsl: where the palette (of one instance: the set's paletteSize() entries) takes each
    /// vertex, in the character's own space; computed in double. outPositions: one a vertex.
    void computePositions(const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& outPositions) const;

    /// Writes the palette's place into the program that is applied, then draws; all instances of a crowd at once.
    void drawImplementation(osg::RenderInfo& renderInfo) const override;
    osg::VertexArrayState* createVertexArrayStateImplementation(osg::RenderInfo& renderInfo) const override;
    void compileGLObjects(osg::RenderInfo& renderInfo) const override;
    void releaseGLObjects(osg::State* state = nullptr) const override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    /// Transforms of the vertices by others (the Optimizer's) would break the bind pose: refused.
    void accept(osg::Drawable::AttributeFunctor&) override {}
    using osg::Geometry::accept;

protected:
    ~SkinnedGeometry() override;

private:
    void drawInstances(osg::RenderInfo& renderInfo, const PaletteBinding& binding, const PosePipeline& pipeline) const;
    void drawPlaced(osg::RenderInfo& renderInfo, const PaletteBinding& binding, const PosePipeline& pipeline) const;
    template <typename Draw>
    void withVertexArrays(osg::RenderInfo& renderInfo, Draw draw) const;
    void drawPrimitives(osg::State& state, int count, int level) const;
    void bindPalette(osg::State& state, const PalettePlace& place) const;
    glm::dvec3 morphed(const osg::Vec3& position, std::size_t vertex, const std::vector<AffineMatrix>& palette) const;

    int _influences = 1;  ///< of a vertex, at most
    int _rigidEntry = -1; ///< the entry that moves all vertices wholly; -1: influences are per vertex
    std::vector<MorphTarget> _morphTargets;
    std::unique_ptr<MorphDeltas> _morphDeltas; ///< never null
    mutable std::atomic<bool> _isMorphLimitReported{false};
    int _morph = -1;
    int _morphEntry = -1;             ///< the first palette entry of the weights
    std::unique_ptr<MeshLod> _detail; ///< never null
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
