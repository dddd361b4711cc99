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

const CrowdInstances& CrowdDetail::instances(const AnimatedCrowd& crowd)
{
    return *crowd._instances;
}

const osg::Group& CrowdDetail::drawnMeshes(const AnimatedCrowd& crowd)
{
    return crowd._meshes.drawn();
}

const std::shared_ptr<const CharacterLevels>& CrowdDetail::levels(const AnimatedCrowd& crowd)
{
    return crowd._meshes._levels;
}

void CrowdDetail::setLevels(AnimatedCrowd& crowd, std::shared_ptr<const CharacterLevels> levels)
{
    crowd._meshes._levels = std::move(levels);
    crowd._meshes.showLevels();
}

} // namespace osgGpuAnimation
