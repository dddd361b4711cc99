// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/bounds/ClipTravel.h>
#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>
#include <osgGpuAnimation/nodes/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/frame/PoseFrame.h>
#include <osgGpuAnimation/nodes/lod/LodSelection.h>

#include <osg/Group>

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The poses that instances of a crowd with a pixel error share. A clip is cut into phases of equal ClipTravel, the
/// more the larger an instance is on screen; all instances in one phase show the pose of its middle. The distance of a
/// vertex from its exact place, plus the error of the level of detail, stays within the pixel error. Instances that
/// show more phases than `mostPhases` have poses of their own, and so do those with a controller, which the crowd
/// submits itself.
class SharedPoses
{
public:
    static constexpr int mostPhases = 512; ///< of a clip, a power of two

    /// meshes: the crowd's, among its children.
    SharedPoses(const osg::Group& meshes, const AnimationSet& set);
    /// Shares what was computed from the meshes.
    SharedPoses(const SharedPoses& other) : _meshes(other._meshes) {}
    SharedPoses& operator=(const SharedPoses&) = delete;

    /// True if the group still has the same meshes.
    bool isOf(const osg::Group& meshes) const;

    /// Submits the visible instances without a controller to the frame, takes them out of the list, and returns a state
    /// for each draw of the crowd's meshes. scale: of the camera that culls. Cameras may cull concurrently.
    std::vector<DrawState> submit(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                  std::vector<std::uint32_t>& seen) const;

private:
    /// What depends on the meshes.
    struct Meshes
    {
        std::vector<const osg::Node*> children;
        std::vector<ClipTravel> travels; ///< by clip, as the others
        std::vector<double> durations;   ///< seconds
        std::vector<double> roundsPerSecond;
    };
    class Collection;

    std::shared_ptr<const PlacedInstances> shared(std::shared_ptr<PlacedInstances> placed) const;

    std::shared_ptr<const Meshes> _meshes;
    mutable std::mutex _mutex;
    mutable std::vector<std::shared_ptr<const PlacedInstances>> _latest; ///< lists of the last frames
    mutable std::size_t _next = 0;                                       ///< the one to replace
};

} // namespace osgGpuAnimation
