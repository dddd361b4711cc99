// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/CrowdInstances.h>
#include <osgGpuAnimation/nodes/CrowdView.h>
#include <osgGpuAnimation/nodes/PoseFrame.h>
#include <osgGpuAnimation/nodes/UpdateRate.h>

#include <osg/StateSet>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// Has the poses of what a camera sees of a crowd evaluated: in one batch for those that show one clip and one for
/// those whose clips are mixed, where there are many (PoseBatch::Load); and one more for each group of instances that
/// are small enough not to be up to date. A group's batch says the same until its turn comes, so the pipeline keeps its
/// palette; it is computed anew when an instance comes, goes or is moved.
///
/// seen: indices; used up. Returns the states under which the crowd's meshes are to be drawn, each in turn; they are
/// the frame's.
std::vector<osg::StateSet*> enlistCrowd(PoseFrame& frame, const CrowdInstances& instances, const CrowdView& view,
                                        const UpdateRate& rate, std::vector<std::uint32_t>& seen);

} // namespace osgGpuAnimation
