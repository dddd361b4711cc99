// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>

namespace osgGpuAnimation
{

Result<void> CrowdDetail::setAnimationSet(AnimatedCrowd& crowd, std::shared_ptr<const AnimationSet> set)
{
    if (crowd.getNumInstances() > 0 || crowd.getAnimationSet().paletteSize() > 0)
        return Error{"a crowd that has a set keeps it"};
    if (!set) return Error{"a crowd needs a set"};
    crowd._instances->setSet(std::move(set));
    crowd.computeBounds();
    crowd.dirtyBound();
    return crowd._meshes.setPixelError(crowd._meshes.getPixelError());
}

} // namespace osgGpuAnimation
