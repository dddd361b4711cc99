// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/CrowdInstances.h>
#include <osgGpuAnimation/nodes/PosedMeshes.h>

#include <map>
#include <memory>
#include <mutex>

namespace osgGpuAnimation
{

/// The posed meshes of those instances of a crowd that were asked for of late: rays hit few of many. Any thread may
/// ask.
class PosedInstances
{
public:
    /// Instances kept; with one more all go. Enough for what lies along a ray, and small beside the crowd's meshes.
    static constexpr std::size_t maxKept = 64;

    std::shared_ptr<PosedMeshes> of(CrowdInstances::Handle instance);

private:
    std::mutex _mutex;
    std::map<CrowdInstances::Handle, std::shared_ptr<PosedMeshes>> _kept;
};

} // namespace osgGpuAnimation
