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

void MaskTable::keep(const std::shared_ptr<const SetMask>& mask)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (std::find(_kept.begin(), _kept.end(), mask) == _kept.end()) _kept.push_back(mask);
}

std::size_t MaskTable::count() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return static_cast<std::size_t>(
        std::count_if(_masks.begin(), _masks.end(), [](const auto& mask) { return !mask.expired(); }));
}

std::shared_ptr<const SetMask> MaskTable::find(std::uint32_t number) const
{
    if (number == 0) return nullptr;
    const std::lock_guard<std::mutex> lock(_mutex);
    return number <= _masks.size() ? _masks[number - 1].lock() : nullptr;
}

const float* MaskTable::weights(std::uint32_t number) const
{
    const std::shared_ptr<const SetMask> mask = find(number);
    return mask ? mask->weights.data() : nullptr;
}

} // namespace osgGpuAnimation
