// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/bounds/ClipTravel.h>
#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/nodes/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/frame/PoseFrame.h>
#include <osgGpuAnimation/nodes/lod/LodSelection.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/Group>

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The poses that instances of a crowd with a pixel error share: those at `mostSteps` steps of equal ClipTravel of each
/// clip. The distance of a vertex from its exact place, plus the error of the level of detail, stays within the pixel
/// error. Instances whose error is less than half a step have poses of their own, and so do those with a controller:
/// the crowd submits them itself.
class SharedPoses
{
public:
    static constexpr int mostSteps = 1024; ///< of a clip

    /// crowd: the node with the meshes.
    SharedPoses(const osg::Group& crowd, const AnimationSet& set);
    /// Shares what was computed from the meshes.
    SharedPoses(const SharedPoses& other) : _meshes(other._meshes) {}
    SharedPoses& operator=(const SharedPoses&) = delete;

    /// True if the crowd still has the same meshes.
    bool isOf(const osg::Group& crowd) const;
    /// Called in each update: forgets the lists that were not drawn since the last call.
    void forgetUnused();

    /// Submits the visible instances that share poses to the frame, takes them out of the list, and returns a state for
    /// each draw of the crowd's meshes. scale: of the camera that culls. Cameras may cull concurrently.
    std::vector<DrawState> submit(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                  std::vector<std::uint32_t>& seen) const;

private:
    /// A mesh and what its vertices are.
    struct Shape
    {
        explicit Shape(SkinnedGeometry& mesh);
        bool operator==(const Shape& other) const { return mesh == other.mesh && vertices == other.vertices; }

        osg::ref_ptr<const SkinnedGeometry> mesh;
        osg::ref_ptr<const osg::Array> vertices;
    };
    struct SharedClip
    {
        ClipTravel travel;
        double duration;      ///< seconds
        float stepsPerTravel; ///< 0: a clip without motion
    };
    /// What depends on the meshes.
    struct Meshes
    {
        std::vector<Shape> shapes;
        std::vector<SharedClip> clips;
    };
    class Collection;

    static std::vector<Shape> shapesBelow(const osg::Group& crowd);
    std::shared_ptr<const PlacedInstances> shared(std::shared_ptr<PlacedInstances> placed) const;

    std::shared_ptr<const Meshes> _meshes;
    mutable std::mutex _mutex;
    mutable std::vector<std::shared_ptr<const PlacedInstances>> _latest; ///< lists drawn since the last update
    std::vector<std::shared_ptr<const PlacedInstances>> _before;         ///< those of the update before
};

} // namespace osgGpuAnimation
