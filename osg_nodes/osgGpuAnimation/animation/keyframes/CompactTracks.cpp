// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>

#include <layout.glsl>

#include <glm/common.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

QuantizedVec3 QuantizedVec3::of(const glm::uvec3& numbers, std::uint32_t place)
{
    assert(numbers.x <= largest && numbers.y <= largest && numbers.z <= largest && place < 4 &&
           "20 bits a number, 2 for the place");
    return {numbers.x | numbers.y << 20, numbers.y >> 12 | numbers.z << 8 | place << 28};
}

glm::uvec3 QuantizedVec3::numbers() const
{
    return {low & largest, low >> 20 | (high & 0xFFu) << 12, high >> 8 & largest};
}

QuantizedVec3 QuantizedVec3::ofRotation(const glm::vec4& q)
{
    const glm::dvec4 unit = Rotation::unit(glm::dvec4(q));
    int place = 0;
    for (int i = 1; i < 4; ++i)
        if (std::abs(unit[i]) > std::abs(unit[place])) place = i;
    glm::uvec3 numbers;
    int next = 0;
    for (int i = 0; i < 4; ++i)
    {
        if (i == place) continue;
        const double component = unit[place] < 0.0 ? -unit[i] : unit[i];
        const double number =
            static_cast<double>(POSE_ROTATION_ZERO) + std::round(component / static_cast<double>(POSE_ROTATION_STEP));
        numbers[next++] = static_cast<std::uint32_t>(std::clamp(number, 0.0, static_cast<double>(largest)));
    }
    return of(numbers, static_cast<std::uint32_t>(place));
}

glm::vec4 QuantizedVec3::rotation() const
{
    const glm::vec3 v = (glm::vec3(numbers()) - POSE_ROTATION_ZERO) * POSE_ROTATION_STEP;
    const float rest = std::sqrt(std::max(1.0f - (v.x * v.x + v.y * v.y + v.z * v.z), 0.0f));
    switch (place())
    {
    case 0:
        return {rest, v.x, v.y, v.z};
    case 1:
        return {v.x, rest, v.y, v.z};
    case 2:
        return {v.x, v.y, rest, v.z};
    default:
        return {v.x, v.y, v.z, rest};
    }
}

namespace
{

using Part = glm::vec4 JointTransform::*;

/// The keyframes of one joint within interleaved tracks.
struct TrackKeys
{
    JointTransform* first;
    std::size_t stride;
    std::size_t count;

    JointTransform& operator[](std::size_t keyframe) const { return first[keyframe * stride]; }
    bool move(Part part) const
    {
        for (std::size_t k = 1; k < count; ++k)
            if ((*this)[k].*part != (*this)[0].*part) return true;
        return false;
    }
};

CompactTracks::Range rangeOf(const TrackKeys& keys, Part part)
{
    glm::vec3 least(keys[0].*part), most = least;
    for (std::size_t k = 1; k < keys.count; ++k)
    {
        least = glm::min(least, glm::vec3(keys[k].*part));
        most = glm::max(most, glm::vec3(keys[k].*part));
    }
    return {least, (most - least) / static_cast<float>(QuantizedVec3::largest)};
}

bool isFinite(const CompactTracks::Range& range)
{
    const glm::vec3 sum = glm::abs(range.base) + glm::abs(range.step);
    return std::isfinite(sum.x + sum.y + sum.z);
}

} // namespace

QuantizedVec3 CompactTracks::Range::pack(const glm::vec3& value) const
{
    glm::uvec3 numbers(0);
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!(step[axis] > 0.0f)) continue;
        const double number = std::round((static_cast<double>(value[axis]) - static_cast<double>(base[axis])) /
                                         static_cast<double>(step[axis]));
        // The comparison makes NaN give 0.
        if (number > 0.0)
            numbers[axis] = static_cast<std::uint32_t>(std::min(number, static_cast<double>(QuantizedVec3::largest)));
    }
    return QuantizedVec3::of(numbers, 0);
}

glm::vec3 CompactTracks::Range::unpack(const QuantizedVec3& packed) const
{
    return base + step * glm::vec3(packed.numbers());
}

CompactTracks CompactTracks::pack(std::vector<JointTransform>& data, std::size_t trackCount, std::size_t jointCount)
{
    CompactTracks compact;
    compact.tracks.resize(jointCount);
    const std::size_t keyframeCount = trackCount == 0 ? 0 : data.size() / trackCount;
    const auto keysOf = [&](std::size_t joint) { return TrackKeys{&data[joint], trackCount, keyframeCount}; };
    const auto column = [&](const TrackKeys& keys, Part part)
    { return keys.move(part) ? static_cast<int>(compact.columnCount++) : -1; };
    for (std::size_t joint = 0; joint < jointCount; ++joint)
    {
        Track& track = compact.tracks[joint];
        const TrackKeys keys = keysOf(joint);
        track.translation = column(keys, &JointTransform::translation);
        track.rotation = column(keys, &JointTransform::rotation);
        track.scale = column(keys, &JointTransform::scale);
        if (track.translation >= 0) track.translationRange = rangeOf(keys, &JointTransform::translation);
        if (track.scale >= 0) track.scaleRange = rangeOf(keys, &JointTransform::scale);
    }
    compact.keyframes.resize(keyframeCount * compact.columnCount);
    for (std::size_t joint = 0; joint < jointCount; ++joint)
        for (std::size_t k = 0; k < keyframeCount; ++k)
            compact.packTransform(k, compact.tracks[joint], data[k * trackCount + joint]);
    return compact;
}

bool CompactTracks::isFor(std::size_t jointCount, std::size_t keyframeCount) const
{
    const auto isColumn = [&](int column)
    { return column == -1 || (column >= 0 && static_cast<std::size_t>(column) < columnCount); };
    const auto isSound = [&](const Track& track)
    {
        return isColumn(track.translation) && isColumn(track.rotation) && isColumn(track.scale) &&
               isFinite(track.translationRange) && isFinite(track.scaleRange);
    };
    return tracks.size() == jointCount && keyframes.size() == columnCount * keyframeCount &&
           std::all_of(tracks.begin(), tracks.end(), isSound);
}

void CompactTracks::unpack(std::vector<JointTransform>& data, std::size_t trackCount) const
{
    const std::size_t keyframeCount = trackCount == 0 ? 0 : data.size() / trackCount;
    for (std::size_t k = 0; k < keyframeCount; ++k)
        for (std::size_t joint = 0; joint < tracks.size(); ++joint)
            unpackTransform(k, tracks[joint], data[k * trackCount + joint]);
}

void CompactTracks::unpackTransform(std::size_t keyframe, const Track& track, JointTransform& transform) const
{
    const auto at = [&](int column) { return keyframes[keyframe * columnCount + static_cast<std::size_t>(column)]; };
    if (track.translation >= 0)
        transform.translation = glm::vec4(track.translationRange.unpack(at(track.translation)), 0.0f);
    if (track.rotation >= 0) transform.rotation = at(track.rotation).rotation();
    if (track.scale >= 0) transform.scale = glm::vec4(track.scaleRange.unpack(at(track.scale)), 0.0f);
}

void CompactTracks::packTransform(std::size_t keyframe, const Track& track, JointTransform& transform)
{
    const auto at = [&](int column) -> QuantizedVec3&
    { return keyframes[keyframe * columnCount + static_cast<std::size_t>(column)]; };
    if (track.translation >= 0) at(track.translation) = track.translationRange.pack(glm::vec3(transform.translation));
    if (track.rotation >= 0) at(track.rotation) = QuantizedVec3::ofRotation(transform.rotation);
    if (track.scale >= 0) at(track.scale) = track.scaleRange.pack(glm::vec3(transform.scale));
    unpackTransform(keyframe, track, transform);
}

} // namespace osgGpuAnimation
