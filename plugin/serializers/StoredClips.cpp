// SPDX-License-Identifier: MIT
#include "serializers/StoredClips.h"

#include "serializers/StoredCompactTracks.h"
#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <osgGpuAnimation/animation/ClipParts.h>
#include <osgGpuAnimation/animation/RootMotionCurve.h>

#include <algorithm>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::size_t floatsATransform = sizeof(JointTransform) / sizeof(float);
/// Of all compact clips of a set together; the default of glTF's readers.
constexpr std::size_t maxCompactBytes = std::size_t(2) << 30;

void writeVector(ValueWriter& out, const glm::dvec3& vector)
{
    out.real(vector.x).real(vector.y).real(vector.z);
}

glm::dvec3 readVector(ValueReader& in)
{
    const double x = in.real(), y = in.real();
    return {x, y, in.real()};
}

void writePoint(ValueWriter& out, const RootMotionCurve::Point& point)
{
    writeVector(out, point.value);
    writeVector(out, point.in);
    writeVector(out, point.out);
}

RootMotionCurve::Point readPoint(ValueReader& in)
{
    RootMotionCurve::Point point;
    point.value = readVector(in);
    point.in = readVector(in);
    point.out = readVector(in);
    return point;
}

void writeMotion(ValueWriter& out, const RootMotionCurve* curve)
{
    out.open("RootMotion", curve ? curve->keys.size() : 0);
    if (curve)
    {
        out.property("Joint").count(curve->joint);
        writeVector(out, curve->up);
        out.endLine();
    }
    for (std::size_t k = 0; curve && k < curve->keys.size(); ++k)
    {
        out.property("Key").real(curve->keys[k].yaw);
        writePoint(out, curve->keys[k].displacement);
        writePoint(out, curve->keys[k].pivot);
        out.endLine();
    }
    out.close();
}

std::shared_ptr<const RootMotionCurve> readMotion(ValueReader& in)
{
    std::shared_ptr<RootMotionCurve> curve;
    const std::size_t count = in.open("RootMotion");
    if (count > 0)
    {
        curve = std::make_shared<RootMotionCurve>();
        curve->joint = in.property("Joint").count();
        curve->up = readVector(in);
    }
    for (std::size_t k = 0; k < count && in.isGood(); ++k)
    {
        RootMotionCurve::Key key;
        key.yaw = in.property("Key").real();
        key.displacement = readPoint(in);
        key.pivot = readPoint(in);
        curve->keys.push_back(key);
    }
    in.close();
    return curve;
}

void writeMarkers(ValueWriter& out, const std::vector<ClipMarker>& markers)
{
    out.open("Markers", markers.size());
    for (const ClipMarker& marker : markers)
        out.property("Marker").real(marker.time).text(marker.name).endLine();
    out.close();
}

std::vector<ClipMarker> readMarkers(ValueReader& in)
{
    std::vector<ClipMarker> markers;
    const std::size_t count = in.open("Markers");
    for (std::size_t m = 0; m < count && in.isGood(); ++m)
    {
        ClipMarker marker;
        marker.time = in.property("Marker").real();
        marker.name = in.text();
        markers.push_back(std::move(marker));
    }
    in.close();
    return markers;
}

std::vector<JointTransform> toTransforms(const std::vector<float>& floats)
{
    std::vector<JointTransform> transforms(floats.size() / floatsATransform);
    const std::size_t count = transforms.size() * floatsATransform;
    if (count > 0) std::copy_n(floats.data(), count, &transforms.front().translation.x);
    return transforms;
}

} // namespace

void writeClips(ValueWriter& out, const std::vector<Clip>& clips)
{
    out.open("Clips", clips.size());
    for (const Clip& clip : clips)
    {
        out.property("Clip").text(clip.name()).flag(clip.form() == Clip::Form::Spline);
        out.flag(clip.compactTracks() != nullptr).endLine();
        out.block("Times", clip.times().data(), clip.times().size(), 8);
        if (clip.compactTracks())
            writeCompactKeyframes(out, clip);
        else
            out.block("Keyframes", &clip.data().data()->translation.x, clip.data().size() * floatsATransform,
                      floatsATransform);
        writeMarkers(out, clip.markers());
        writeMotion(out, clip.rootMotion());
    }
    out.close();
}

std::vector<Clip> readClips(ValueReader& in, const Skeleton& skeleton, const std::vector<MorphWeights>& morphs,
                            bool mayBeCompact)
{
    std::vector<Clip> clips;
    std::size_t bytesLeft = maxCompactBytes;
    const std::size_t count = in.open("Clips");
    for (std::size_t c = 0; c < count && in.isGood(); ++c)
    {
        ClipParts parts;
        parts.name = in.property("Clip").text();
        parts.form = in.flag() ? Clip::Form::Spline : Clip::Form::Linear;
        const bool isCompact = mayBeCompact && in.flag();
        parts.jointCount = parts.trackCount = skeleton.jointCount();
        for (const MorphWeights& morph : morphs)
            parts.trackCount += morph.blockCount();
        parts.times = in.block("Times");
        if (isCompact)
            readCompactKeyframes(in, parts, bytesLeft);
        else
            parts.data = toTransforms(in.block("Keyframes"));
        parts.markers = readMarkers(in);
        parts.rootMotion = readMotion(in);
        if (!in.isGood()) break;
        Result<Clip> clip = Clip::create(std::move(parts));
        if (!clip)
            in.fail(clip.error().message);
        else
            clips.push_back(std::move(clip).value());
    }
    in.close();
    return clips;
}

} // namespace osgGpuAnimation::serializers
