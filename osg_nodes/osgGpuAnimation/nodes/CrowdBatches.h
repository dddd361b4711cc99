// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/CrowdDetail.h>
#include <osgGpuAnimation/nodes/CrowdGroups.h>
#include <osgGpuAnimation/nodes/CrowdInstances.h>
#include <osgGpuAnimation/nodes/CrowdView.h>
#include <osgGpuAnimation/nodes/PoseFrame.h>
#include <osgGpuAnimation/nodes/UpdateRate.h>

#include <osg/Camera>

#include <memory>
#include <mutex>
#include <unordered_map>

namespace osgGpuAnimation
{

/// Has the poses of what cameras see of a crowd evaluated: what is to be up to date in one batch for those that show
/// one clip and one for those whose clips are mixed, where there are many (PoseBatch::Load), and in one more for each
/// group of small instances (see UpdateRate) the poses of its last turn, which the pipeline still has. Keeps a camera's
/// groups as long as it sees the crowd. Several cameras may cull at once.
class CrowdBatches
{
public:
    /// How the crowd's meshes are to be drawn, once for each of these.
    struct Draw
    {
        osg::StateSet* stateSet; ///< the frame's
        bool isPlaced;           ///< instances stand in the eye's space already
    };

    /// frame: that of the visitor's cull. detail: by which each level of detail in use is drawn by itself. seen:
    /// indices; used up.
    std::vector<Draw> enlist(PoseFrame& frame, const CrowdInstances& instances, osgUtil::CullVisitor& visitor,
                             const UpdateRate& rate, const CrowdDetail& detail, std::vector<std::uint32_t>& seen);

private:
    struct Kept
    {
        CrowdGroups groups;
        unsigned int frameNumber = 0; ///< in which they were last used
    };

    CrowdGroups& groupsOf(const osg::Camera* camera, unsigned int frameNumber);

    std::mutex _mutex;
    std::unordered_map<const osg::Camera*, Kept> _kept;
};

} // namespace osgGpuAnimation
