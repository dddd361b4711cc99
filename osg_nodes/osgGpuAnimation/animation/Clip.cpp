// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Clip.h>

#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

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

Clip Clip::withName(std::string name) const
{
    Clip clip = *this;
    clip._name = std::move(name);
    return clip;
}

namespace
{

bool isFinite(const RootMotionCurve::Point& point)
{
    const glm::dvec3 sum = glm::abs(point.value) + glm::abs(point.in) + glm::abs(point.out);
    return std::isfinite(sum.x + sum.y + sum.z);
}

std::optional<std::string> findFaultInTimes(const std::vector<float>& times)
{
    if (times.empty()) return "it has no keyframes";
    for (std::size_t k = 0; k < times.size(); ++k)
    {
        const char* fault = nullptr;
        if (!std::isfinite(times[k]) || times[k] < 0.0f)
            fault = "is negative or not finite";
        else if (k > 0 && times[k] < times[k - 1])
            fault = "is before the one before it";
        else if (k > 1 && times[k] == times[k - 2])
            fault = "occurs more than twice";
        if (fault) return "time " + std::to_string(k) + " (" + std::to_string(times[k]) + ") " + fault;
    }
    return std::nullopt;
}

std::optional<std::string> findFaultInData(const ClipParts& parts)
{
    const std::size_t perTrack = Clip::transformsPerTrack(parts.form);
    const std::size_t wanted = parts.times.size() * parts.trackCount * perTrack;
    if (parts.data.size() != wanted)
        return std::to_string(wanted) + " joint transforms are needed, but there are " +
               std::to_string(parts.data.size());
    for (std::size_t i = 0; i < wanted; ++i)
    {
        const JointTransform& transform = parts.data[i];
        const std::size_t track = i / perTrack % parts.trackCount;
        const char* fault = nullptr;
        if (!transform.isFinite())
            fault = "a number is not finite";
        else if (perTrack == 1 && track < parts.jointCount && !(glm::length(transform.rotation) > 0.0f))
            fault = "the rotation has length 0";
        if (fault)
            return "track " + std::to_string(track) + " at keyframe " +
                   std::to_string(i / perTrack / parts.trackCount) + ": " + fault;
    }
    return std::nullopt;
}

std::optional<std::string> findFaultInMotion(const ClipParts& parts)
{
    if (!parts.rootMotion) return std::nullopt;
    const RootMotionCurve& curve = *parts.rootMotion;
    if (curve.joint >= parts.jointCount) return "the joint of its root motion does not exist";
    if (curve.keys.size() != parts.times.size())
        return "its root motion has " + std::to_string(curve.keys.size()) + " keys for " +
               std::to_string(parts.times.size()) + " keyframes";
    const double length = glm::length(curve.up);
    bool isSound = length > 0.0 && std::isfinite(length);
    for (const RootMotionCurve::Key& key : curve.keys)
        isSound = isSound && isFinite(key.displacement) && isFinite(key.pivot) && std::isfinite(key.yaw);
    return isSound ? std::nullopt : std::optional<std::string>("a number of its root motion is not finite");
}

/// Compact tracks are checked before the data, since they decode into it.
std::optional<std::string> findFaultInCompactTracks(const ClipParts& parts)
{
    if (!parts.compactTracks) return std::nullopt;
    const bool isSound =
        parts.form == Clip::Form::Linear && parts.data.size() == parts.times.size() * parts.trackCount &&
        parts.jointCount <= parts.trackCount && parts.compactTracks->isFor(parts.jointCount, parts.times.size());
    return isSound ? std::nullopt : std::optional<std::string>("its compact keyframes do not fit the clip");
}

} // namespace

Result<Clip> Clip::create(ClipParts parts)
{
    std::optional<std::string> fault = findFaultInTimes(parts.times);
    if (!fault) fault = findFaultInCompactTracks(parts);
    if (!fault && parts.compactTracks) parts.compactTracks->unpack(parts.data, parts.trackCount);
    if (!fault) fault = findFaultInData(parts);
    if (!fault) fault = findFaultInMotion(parts);
    if (fault) return Error{"clip \"" + parts.name + "\": " + *fault};
    Clip clip;
    clip._name = std::move(parts.name);
    clip._form = parts.form;
    clip._trackCount = parts.trackCount;
    clip._times = std::move(parts.times);
    clip._data = std::make_shared<std::vector<JointTransform>>(std::move(parts.data));
    clip._rootMotion = std::move(parts.rootMotion);
    clip._compactTracks = std::move(parts.compactTracks);
    return clip.withMarkers(std::move(parts.markers));
}

} // namespace osgGpuAnimation
