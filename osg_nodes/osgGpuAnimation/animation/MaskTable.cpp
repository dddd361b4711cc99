// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/MaskTable.h>

#include <algorithm>

namespace osgGpuAnimation
{

std::shared_ptr<const SetMask> MaskTable::use(const std::vector<float>& weights)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::size_t place = _masks.size();
    for (std::size_t m = _masks.size(); m-- > 0;)
    {
        const std::shared_ptr<const SetMask> mask = _masks[m].lock();
        if (mask && mask->weights == weights) return mask;
        if (!mask) place = m;
    }
    if (place >= maxMasks) return nullptr;
    const auto made = std::make_shared<const SetMask>(SetMask{static_cast<std::uint32_t>(place + 1), weights});
    _masks.resize(std::max(_masks.size(), place + 1));
    _masks[place] = made;
    return made;
}

std::shared_ptr<const SetMask> MaskTable::find(std::uint32_t number) const
{
    if (number == 0) return nullptr;
    const std::lock_guard<std::mutex> lock(_mutex);
    return number <= _masks.size() ? _masks[number - 1].lock() : nullptr;
}

} // namespace osgGpuAnimation
