// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/CrowdDetail.h>
#include <osgGpuAnimation/nodes/CrowdInstances.h>
#include <osgGpuAnimation/nodes/PoseFrame.h>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// Has the frame evaluate the poses of the instances that a camera sees of a crowd, and returns the states to draw the
/// crowd's meshes with, one a draw. Instances that show one clip form one batch, those that mix clips others, where
/// there are many (PoseBatch::Load). Each level of detail in use has a draw of its own. seen: indices. Several cameras
/// may cull at once.
std::vector<DrawState> enlistSeen(PoseFrame& frame, const CrowdInstances& instances, const CrowdDetail& detail,
                                  const std::vector<std::uint32_t>& seen);

} // namespace osgGpuAnimation
