// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/bounds/ClipTravel.h>
#include <osgGpuAnimation/animation/bounds/MixBounds.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/crowd/OutfitLists.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/frame/stage/PoseFrame.h>
#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Group>

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The poses that instances of a crowd with a pixel error share: those at `maxSteps` steps of equal ClipTravel of each
/// clip. The distance of a vertex from its exact place, plus the error of the level of detail, stays within the pixel
/// error. Instances whose error is less than half a step have poses of their own, and so do those with a controller:
/// the crowd submits them itself.
class SharedPoses
{
public:
    static constexpr int maxSteps = 1024; ///< of a clip

    /// Begins to compute the steps in a thread: 2 ms a clip of the Knight. crowd: the node with the meshes.
    SharedPoses(const osg::Group& crowd, const std::shared_ptr<const AnimationSet>& set);
    /// Shares what was computed from the meshes.
    SharedPoses(const SharedPoses& other) : _meshes(other._meshes) {}
    SharedPoses& operator=(const SharedPoses&) = delete;

    /// True if the crowd still has the same meshes.
    bool isOf(const osg::Group& crowd) const;
    /// Called in each update: forgets the lists that were not drawn since the last call. waits: until the thread ends.
    void update(bool waits);
    /// True: the thread had ended at the last update(), and submit() may be called; the same in a frame's cameras.
    bool areUsed() const { return _areUsed; }

    /// Submits the visible instances that share poses to the frame and returns a state for each draw of the crowd's
    /// meshes. outOthers: the indices of the others. scale: of the camera that culls. lists: of a crowd with outfits;
    /// null: none. Cameras may cull concurrently.
    std::vector<DrawState> submit(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                  const DrawnLists* lists, const SeenMembers& seen,
                                  std::vector<std::uint32_t>& outOthers) const;

private:
    /// A mesh and what its vertices are.
    struct Shape
    {
        explicit Shape(SkinnedGeometry& mesh) : mesh(&mesh), vertices(mesh.getVertexArray()) {}
        bool operator==(const Shape& other) const { return mesh == other.mesh && vertices == other.vertices; }

        osg::ref_ptr<const SkinnedGeometry> mesh;
        osg::ref_ptr<const osg::Array> vertices;
    };
    struct SharedClip
    {
        ClipTravel travel{};
        double duration = 0.0;            ///< seconds
        float stepsPerTravel = 0.0f;      ///< 0: a clip without motion
        float minReach = -1.0f;           ///< in steps; an instance that reaches less has a pose of its own
        std::vector<BlendSample> poses{}; ///< by step
    };
    /// What depends on the meshes.
    struct Meshes
    {
        ~Meshes() { isStopped = true; } // before the future waits
        void addClips(const AnimationSet& set, const MixBounds::Boxes& boxes);

        std::vector<Shape> shapes;
        std::vector<SharedClip> clips; ///< of instances with a controller: none share; the rest pose; those of the set
        std::atomic<bool> isMade{false}, isStopped{false};
        std::future<void> thread; ///< the last member: it uses the others
    };
    class Collection;

    static std::vector<Shape> shapesBelow(const osg::Group& crowd);
    std::shared_ptr<const PlacedInstances> shared(std::shared_ptr<PlacedInstances> placed) const;

    std::shared_ptr<const Meshes> _meshes;
    bool _areUsed = false;
    mutable std::mutex _mutex;
    mutable std::vector<std::shared_ptr<const PlacedInstances>> _latest; ///< lists drawn since the last update
    std::vector<std::shared_ptr<const PlacedInstances>> _before;         ///< those of the update before
};

/// Submits the visible instances of a crowd to the frame and returns a state for each draw of the crowd's meshes.
/// shared: of the crowd; null: no instances share poses. lists: of a crowd with outfits; null: none.
std::vector<DrawState> submitSeen(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                  const SharedPoses* shared, const DrawnLists* lists, const SeenMembers& seen);

} // namespace osgGpuAnimation
