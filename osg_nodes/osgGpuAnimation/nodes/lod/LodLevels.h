// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <osg/Geometry>
#include <osg/State>

#include <glm/vec3.hpp>

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// Poses of a set that differ as much as they can: the rest pose first, then one after another of the clips' poses,
/// each the one whose joints are farthest from where all before have them (from the joints' mean, so that walking does
/// not count). Of up to some 64 times spread over the clips.
/// count: 1 and more; fewer where the clips have no more that differ.
std::vector<PoseInstruction> keyPoses(const AnimationSet& set, std::size_t count);

struct PosedSurface;

/// A mesh drawn with fewer triangles over the same vertices, so that palettes, influences and morph targets
/// stay as they are. A **level** is the error that it may have, as a power of two in the character's own
/// units, whatever space the mesh's arrays are in: at level -3 no vertex of the mesh is farther than 1/8 from the
/// surface that is drawn. So one level says the same of all meshes of a character.
///
/// Made by MeshSimplifier in twelve poses at once (keyPoses() of the set), in each of which the level's error is
/// kept; in other poses it may be more: no more than half as much in tests at random times of real characters' clips.
/// Primitive sets other than indexed triangles are drawn whole at all levels, as are meshes with positions that are not
/// finite or with more than mostVertices. Of each piece of a mesh at least a triangle is left.
///
/// No level is coarser than a 32nd of the character's size, or small characters would get thin; the coarsest alone does
/// not keep texture coordinates on their side of a seam.
///
/// Immutable but for its GL objects, which OSG keeps by context; shared by the threads that cull and draw.
class LodLevels
{
public:
    static constexpr int allTriangles = std::numeric_limits<int>::min(); ///< the level without an error
    static constexpr std::size_t mostVertices = 100'000; ///< of a mesh that levels are made of; they take seconds then

    /// The level of at most that error; allTriangles where it is not above 0.
    static int levelOf(double error);

    /// The positions of the mesh in the pose of a palette (the set's paletteSize() entries): one a vertex.
    using Skinning =
        std::function<void(const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& outPositions)>;

    /// The cost grows with the mesh's points times poses: see MeshSimplifier.
    LodLevels(const osg::Geometry& mesh, const AnimationSet& set, const Skinning& skin);

    /// Whether it was made for what the mesh's arrays and primitives are now.
    bool isOf(const osg::Geometry& mesh) const;

    /// The finest and the coarsest level that has triangles of its own; allTriangles: there is none.
    int finest() const { return _finest; }
    int coarsest() const { return _coarsest; }
    /// What is drawn in the place of the mesh's primitive set of that number; null: itself.
    const osg::DrawElements* elements(std::size_t primitiveSet, int level) const;

    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize) const;

private:
    struct Step
    {
        int level; ///< from that on
        osg::ref_ptr<osg::DrawElements> elements;
    };
    struct Primitives
    {
        osg::ref_ptr<const osg::PrimitiveSet> original;
        unsigned int modifiedCount; ///< of the original
        std::vector<Step> steps;    ///< by rising levels
    };

    void addSteps(const PosedSurface& surface, int finest, int coarsest, Primitives& primitives);

    osg::ref_ptr<const osg::Array> _vertices;
    unsigned int _modifiedCount = 0; ///< of the vertices
    std::vector<Primitives> _primitives;
    osg::ref_ptr<osg::ElementBufferObject> _buffer = new osg::ElementBufferObject;
    int _finest = allTriangles;
    int _coarsest = allTriangles;
};

/// What a mesh keeps of its LodLevels: made when they are first needed, once for all threads, and anew when the
/// mesh's vertices or primitives are others. Copies have the same ones.
class MeshLod
{
public:
    MeshLod() = default;
    MeshLod(const MeshLod& other) : _levels(std::atomic_load(&other._levels)) {}
    MeshLod& operator=(const MeshLod&) = delete;

    /// Several threads that ask wait for the one that makes them.
    std::shared_ptr<const LodLevels> of(const osg::Geometry& mesh, const AnimationSet& set,
                                        const LodLevels::Skinning& skin) const;
    /// Null: they were not made, or are of what the mesh was before.
    std::shared_ptr<const LodLevels> known(const osg::Geometry& mesh) const;
    /// When what the vertices go by has changed.
    void forget();

    void releaseGLObjects(osg::State* state) const;
    void resizeGLObjectBuffers(unsigned int maxSize) const;

private:
    mutable std::mutex _mutex;
    mutable std::shared_ptr<const LodLevels> _levels; ///< read and written as a whole
};

} // namespace osgGpuAnimation
