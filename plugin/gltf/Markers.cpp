// SPDX-License-Identifier: MIT
#include "gltf/Markers.h"

#include <cmath>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

/// What is wrong with a marker; empty: nothing.
const char* faultOf(const tinygltf::Value& marker)
{
    if (!marker.IsObject()) return "no object";
    const tinygltf::Value& time = marker.Get("time");
    if (!time.IsNumber()) return "no number as its time";
    if (!std::isfinite(time.GetNumberAsDouble()) || time.GetNumberAsDouble() < 0.0) return "a time below 0";
    return marker.Get("name").IsString() ? "" : "no text as its name";
}

} // namespace

std::vector<ClipMarker> readMarkers(const tinygltf::Value& extras, const std::string& subject, Report& report)
{
    std::vector<ClipMarker> result;
    if (!extras.IsObject() || !extras.Has("markers")) return result;
    const tinygltf::Value& markers = extras.Get("markers");
    if (!markers.IsArray()) report.warn(subject + ".extras.markers: no array; markers skipped");
    for (std::size_t i = 0; markers.IsArray() && i < markers.ArrayLen(); ++i)
    {
        const tinygltf::Value& marker = markers.Get(i);
        const std::string fault = faultOf(marker);
        if (fault.empty())
            result.push_back({marker.Get("time").GetNumberAsDouble(), marker.Get("name").Get<std::string>()});
        else
            report.warn(subject + ".extras.markers[" + std::to_string(i) + "]: " + fault + "; marker skipped");
    }
    return result;
}

} // namespace osgGpuAnimation::gltf
