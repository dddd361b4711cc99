// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/MaskTable.h>

#include <algorithm>

namespace osgGpuAnimation
{

MaskTable::MaskTable(const MaskTable& other)
{
    const std::lock_guard<std::mutex> lock(other._mutex);
    _masks = other._masks;
}

std::uint32_t MaskTable::add(const std::vector<float>& weights)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto known = std::find(_masks.begin(), _masks.end(), weights);
    if (known == _masks.end())
    {
        if (_masks.size() >= maxMasks) return 0;
        _masks.push_back(weights);
        return static_cast<std::uint32_t>(_masks.size());
    }
    return static_cast<std::uint32_t>(known - _masks.begin()) + 1;
}

std::size_t MaskTable::count() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _masks.size();
}

const float* MaskTable::weights(std::uint32_t number) const
{
    if (number == 0) return nullptr;
    const std::lock_guard<std::mutex> lock(_mutex);
    return number <= _masks.size() ? _masks[number - 1].data() : nullptr;
}

} // namespace osgGpuAnimation
