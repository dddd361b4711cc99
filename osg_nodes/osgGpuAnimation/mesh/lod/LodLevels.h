// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Result.h>

#include <osg/Geometry>
#include <osg/State>

#include <glm/vec3.hpp>

#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <vector>

namespace osgGpuAnimation
{

/// The most different poses of a set: the rest pose, then repeatedly the clip pose whose joints are farthest from those
/// of the poses before it (relative to the joints' mean, so that walking does not count). The candidates are about 64
/// times spread over the clips. count: at least 1; the result is shorter if the clips have fewer different poses.
std::vector<PoseInstruction> keyPoses(const AnimationSet& set, std::size_t count);
/// The poses in which the errors of levels are measured: keyPoses(), and about `otherPoseCount` times spread over the
/// clips, at most a quarter of them in one clip. Both counts: at least 4.
struct MeasuredPoses
{
    MeasuredPoses(const AnimationSet& set, std::size_t maxKeyPoses, std::size_t otherPoseCount);

    std::vector<PoseInstruction> poses; ///< the key poses come first
    std::size_t keyPoseCount;
};

struct PosedSurface;

/// The largest length of a transformed unit axis.
float maxScale(const AffineMatrix& matrix);

/// Reduced triangles for a mesh over the same vertices, so that palettes, influences and morph targets do not change. A
/// **level** is the exponent of the largest error as a power of the square root of two, in the character's own units
/// for any mesh space: at level -6 no vertex of the mesh is farther than 1/8 from the reduced triangles, nor 5/32 from
/// the drawn surface, which is a little larger. One level therefore means the same for all meshes of a character.
///
/// MeshSimplifier keeps the error in 12 to 48 poses at once (keyPoses() of the set; fewer poses for more vertices). The
/// error of the result is measured in about four times as many others, spread over the clips. No levels are built for
/// primitive sets other than indexed triangles, for meshes with positions that are not finite or for more than
/// maxVertices. Each piece of a mesh keeps at least one triangle.
///
/// The coarsest level is a 32nd of the character's size, since coarser ones make small characters thin. Only the
/// coarsest level may cross texture seams.
///
/// Immutable except for its GL objects, which OSG stores per context; shared by cull and draw threads.
class LodLevels
{
public:
    static constexpr int allTriangles = std::numeric_limits<int>::min(); ///< the level without error
    static constexpr std::size_t maxVertices = 100'000; ///< of a mesh with levels; such a mesh takes seconds
    /// The number of key poses in which the error of so many vertices is measured: as many as posedVertices allows, in
    /// [minPoses, maxPoses].
    static std::size_t poseCountOf(std::size_t vertices, std::size_t posedVertices = 21'000);
    static constexpr std::size_t minPoses = 12, maxPoses = 48;

    /// The coarsest level within the error, in the character's units; allTriangles if the error is not above 0.
    static int levelOf(double error);
    /// The finest level that permits the error, in the character's units; allTriangles if the error is not above 0.
    static int levelFor(double error);
    /// The largest error of a level, in the character's units, its outset included. 0 for allTriangles.
    static double errorOf(int level);

    /// Computes one position per vertex in the pose of a palette (the set's paletteSize() entries).
    using Skinning =
        std::function<void(const std::vector<AffineMatrix>& palette, std::vector<glm::dvec3>& outPositions)>;

    /// Levels of the mesh without steps, for addSteps().
    explicit LodLevels(const osg::Geometry& mesh);
    /// The cost is proportional to the mesh's points times poses, see MeshSimplifier.
    /// copy: the mesh, or a copy of it, as it was in the constructor. skin: the copy's. stop: see PosedSurface.
    void addSteps(const osg::Geometry& copy, const AnimationSet& set, const Skinning& skin,
                  const std::atomic<bool>* stop);
    /// Shares the steps of the levels of a mesh with equal vertices and primitives.
    void shareSteps(const LodLevels& other);

    /// The reduced triangles of a primitive set.
    struct Step
    {
        int level = allTriangles;                 ///< and coarser ones
        osg::ref_ptr<osg::DrawElements> elements; ///< null: the primitive set itself
        float outset = 0.0f; ///< how far vertices move along their normals, in the character's units
        double error = 0.0;  ///< the largest distance of a vertex from the drawn surface, in the character's units
    };
    using Steps = std::vector<Step>; ///< by ascending levels
    /// The levels that a file contains. steps: by primitive set, from steps() of the same mesh. They are untrusted: an
    /// error names the first step that does not fit the mesh.
    static Result<std::shared_ptr<const LodLevels>> restored(const osg::Geometry& mesh, std::vector<Steps> steps);
    /// primitiveSet: of the mesh.
    const Steps& steps(std::size_t primitiveSet) const { return _primitives[primitiveSet].steps; }
    /// True if a step with that level and error may follow the previous level (allTriangles: none).
    static bool mayFollow(int previous, int level, double error);

    /// True if the levels match the mesh's present arrays and primitives.
    bool isOf(const osg::Geometry& mesh) const;

    /// The finest and the coarsest level with reduced triangles; allTriangles: no such level.
    int finest() const { return _finest; }
    int coarsest() const { return _coarsest; }
    /// The reduced triangles of the mesh's primitive set at a level. Their vertices lie on the original surface and
    /// most of their area within it; the outset gives them its volume, so that small characters do not get thin.
    const Step& reduced(std::size_t primitiveSet, int level) const;
    /// The largest error of the mesh's reduced triangles at a level; at most errorOf(level).
    double foundError(int level) const;

    /// Whole triangles, by vertex; empty for null, other primitives and vertices that do not exist.
    static std::vector<std::uint32_t> trianglesOf(const osg::PrimitiveSet* primitives, std::size_t vertexCount);

    void releaseGLObjects(osg::State* state) const { _buffer->releaseGLObjects(state); }
    void resizeGLObjectBuffers(unsigned int maxSize) const { _buffer->resizeGLObjectBuffers(maxSize); }

private:
    struct Primitives
    {
        osg::ref_ptr<const osg::PrimitiveSet> original;
        unsigned int modifiedCount; ///< of the original
        Steps steps;
    };

    Result<void> restore(std::size_t primitiveSet, Steps steps);
    void includeRange(const Steps& steps);
    Steps makeSteps(const PosedSurface& surface, int finest, int coarsest, const osg::PrimitiveSet* primitives,
                    std::set<std::size_t>& outBeyond) const;

    osg::ref_ptr<const osg::Array> _vertices;
    unsigned int _modifiedCount = 0; ///< of the vertices
    std::vector<Primitives> _primitives;
    osg::ref_ptr<osg::ElementBufferObject> _buffer = new osg::ElementBufferObject;
    int _finest = allTriangles;
    int _coarsest = allTriangles;
};

/// The LodLevels of a mesh until its vertices or primitives change. Copies of the mesh share them.
class MeshLod
{
public:
    MeshLod() = default;
    MeshLod(const MeshLod& other) : _levels(std::atomic_load(&other._levels)) {}
    MeshLod& operator=(const MeshLod&) = delete;

    /// Null: not created, or the mesh has changed.
    std::shared_ptr<const LodLevels> known(const osg::Geometry& mesh) const;
    void set(std::shared_ptr<const LodLevels> levels) { std::atomic_store(&_levels, std::move(levels)); }
    /// Discards the levels after a change of influences, morph targets or clips.
    void forget();
    unsigned int forgetCount() const { return _forgetCount; } ///< of calls of forget()

private:
    std::shared_ptr<const LodLevels> _levels; ///< accessed atomically
    std::atomic<unsigned int> _forgetCount{0};
};

} // namespace osgGpuAnimation
