// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PosedInstances.h>

namespace osgGpuAnimation
{

std::shared_ptr<PosedMeshes> PosedInstances::of(CrowdInstances::Handle instance)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto kept = _kept.find(instance);
    if (kept != _kept.end()) return kept->second;
    if (_kept.size() >= maxKept) _kept.clear();
    return _kept[instance] = std::make_shared<PosedMeshes>();
}

} // namespace osgGpuAnimation
