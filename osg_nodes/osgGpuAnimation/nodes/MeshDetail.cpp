// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/MeshDetail.h>

namespace osgGpuAnimation
{

std::shared_ptr<const DetailLevels> MeshDetail::known(const osg::Geometry& mesh) const
{
    std::shared_ptr<const DetailLevels> levels = std::atomic_load(&_levels);
    return levels && levels->isOf(mesh) ? levels : nullptr;
}

std::shared_ptr<const DetailLevels> MeshDetail::of(const osg::Geometry& mesh, const AnimationSet& set,
                                                   const DetailLevels::Skinning& skin) const
{
    if (std::shared_ptr<const DetailLevels> levels = known(mesh)) return levels;
    const std::lock_guard<std::mutex> lock(_mutex);
    if (std::shared_ptr<const DetailLevels> levels = known(mesh)) return levels;
    auto made = std::make_shared<const DetailLevels>(mesh, set, skin);
    std::atomic_store(&_levels, std::shared_ptr<const DetailLevels>(made));
    return made;
}

void MeshDetail::forget()
{
    std::atomic_store(&_levels, std::shared_ptr<const DetailLevels>());
}

void MeshDetail::releaseGLObjects(osg::State* state) const
{
    if (const std::shared_ptr<const DetailLevels> levels = std::atomic_load(&_levels)) levels->releaseGLObjects(state);
}

void MeshDetail::resizeGLObjectBuffers(unsigned int maxSize) const
{
    if (const std::shared_ptr<const DetailLevels> levels = std::atomic_load(&_levels))
        levels->resizeGLObjectBuffers(maxSize);
}

} // namespace osgGpuAnimation
