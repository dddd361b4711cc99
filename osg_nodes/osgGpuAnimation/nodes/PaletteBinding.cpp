// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PaletteBinding.h>

#include <tuple>

namespace osgGpuAnimation
{

PaletteBinding::PaletteBinding(const PaletteBinding& other, const osg::CopyOp& copyop)
    : osg::StateAttribute(other, copyop), _set(other._set), _slot(other._slot), _instance(other._instance),
      _instanceCount(other._instanceCount)
{
}

void PaletteBinding::set(std::shared_ptr<const AnimationSet> set, std::size_t slot, std::size_t instance,
                         std::size_t instanceCount)
{
    _set = std::move(set);
    _slot = slot;
    _instance = instance;
    _instanceCount = instanceCount;
}

int PaletteBinding::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(PaletteBinding, other);
    const auto left = std::make_tuple(_set.get(), _slot, _instance, _instanceCount);
    const auto right = std::make_tuple(rhs._set.get(), rhs._slot, rhs._instance, rhs._instanceCount);
    return left < right ? -1 : (right < left ? 1 : 0);
}

} // namespace osgGpuAnimation
