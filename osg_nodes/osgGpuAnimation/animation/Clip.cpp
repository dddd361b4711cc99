// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Clip.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

Clip::Span Clip::locate(double time) const
{
    // Written so that a time that is not a number gives the first keyframe.
    if (_times.empty() || !(time > static_cast<double>(_times.front()))) return {};
    if (time >= static_cast<double>(_times.back())) return {_times.size() - 1, 0.0f};

    const auto next = std::upper_bound(_times.begin(), _times.end(), time,
                                       [](double wanted, float key) { return wanted < static_cast<double>(key); });
    const double from = static_cast<double>(*(next - 1));
    const auto alpha = static_cast<float>((time - from) / (static_cast<double>(*next) - from));
    static constexpr float justBelowOne = 1.0f - 0x1p-24f;
    return {static_cast<std::size_t>(next - _times.begin()) - 1, std::min(alpha, justBelowOne)};
}

} // namespace osgGpuAnimation
