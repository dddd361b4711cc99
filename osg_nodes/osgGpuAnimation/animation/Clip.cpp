// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Clip.h>

#include <osgGpuAnimation/animation/RootMotionCurve.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

Clip::Span Clip::locate(double time) const
{
    // The negation makes NaN give the first keyframe.
    if (_times.empty() || !(time > static_cast<double>(_times.front()))) return {};
    if (time >= static_cast<double>(_times.back())) return {_times.size() - 1, 0.0f};

    const auto next = std::upper_bound(_times.begin(), _times.end(), time,
                                       [](double wanted, float key) { return wanted < static_cast<double>(key); });
    const double from = static_cast<double>(*(next - 1));
    const auto alpha = static_cast<float>((time - from) / (static_cast<double>(*next) - from));
    static constexpr float justBelowOne = 1.0f - 0x1p-24f;
    return {static_cast<std::size_t>(next - _times.begin()) - 1, std::min(alpha, justBelowOne)};
}

RootMotion Clip::rootMotionAt(double time) const
{
    const Span span = locate(time);
    return _rootMotion->at(span.keyframe, static_cast<double>(span.alpha), _form == Form::Spline);
}

Result<Clip> Clip::withMarkers(std::vector<ClipMarker> markers) const
{
    Clip clip = *this;
    for (ClipMarker& marker : markers)
    {
        if (!std::isfinite(marker.time) || marker.time < 0.0)
            return Error{"marker \"" + marker.name + "\" of clip \"" + _name + "\": its time " +
                         std::to_string(marker.time) + " is negative or not finite"};
        marker.time = std::min(marker.time, duration());
        clip._markers.push_back(std::move(marker));
    }
    std::stable_sort(clip._markers.begin(), clip._markers.end(),
                     [](const ClipMarker& a, const ClipMarker& b) { return a.time < b.time; });
    return clip;
}

} // namespace osgGpuAnimation
