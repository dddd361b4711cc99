// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>

#include <atomic>
#include <tuple>

namespace osgGpuAnimation
{

PaletteBinding::PaletteBinding(const PaletteBinding& other, const osg::CopyOp& copyop)
    : osg::StateAttribute(other, copyop), _set(other._set), _slot(other._slot), _instance(other._instance),
      _instanceCount(other._instanceCount), _lists(other._lists), _placed(other._placed), _serial(other._serial),
      _level(other._level)
{
}

void PaletteBinding::set(std::shared_ptr<const AnimationSet> set, std::size_t slot, std::size_t instance,
                         std::size_t instanceCount)
{
    _set = std::move(set);
    _slot = slot;
    _instance = instance;
    _instanceCount = instanceCount;
    _lists.clear();
    _placed = nullptr;
    _serial = 0;
    _level = allTriangles;
}

void PaletteBinding::setInstanced(std::shared_ptr<const AnimationSet> set, std::size_t slot)
{
    static std::atomic<std::uint64_t> last{0};
    this->set(std::move(set), slot, 0, 0);
    _serial = ++last;
}

void PaletteBinding::setPlaced(std::shared_ptr<const AnimationSet> set, std::size_t slot,
                               std::shared_ptr<const PlacedInstances> placed, std::size_t first, std::size_t count)
{
    this->set(std::move(set), slot, first, count);
    _placed = std::move(placed);
}

std::size_t PaletteBinding::getDrawnCount() const
{
    if (!isInstanced()) return _instanceCount;
    std::size_t count = 0;
    for (const auto& list : _lists)
        count += list->size();
    return count;
}

int PaletteBinding::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(PaletteBinding, other);
    const auto left = std::make_tuple(_set.get(), _slot, _instance, _instanceCount, _serial, _placed.get(), _level);
    const auto right = std::make_tuple(rhs._set.get(), rhs._slot, rhs._instance, rhs._instanceCount, rhs._serial,
                                       rhs._placed.get(), rhs._level);
    return left < right ? -1 : (right < left ? 1 : 0);
}

} // namespace osgGpuAnimation
