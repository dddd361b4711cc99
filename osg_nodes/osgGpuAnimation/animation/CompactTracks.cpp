// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/CompactTracks.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

using Part = glm::vec4 JointTransform::*;

/// One joint's keyframes, by turns with the other tracks'.
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
    return {least, (most - least) / static_cast<float>(PackedTriple::largest)};
}

} // namespace

PackedTriple CompactTracks::Range::pack(const glm::vec3& value) const
{
    glm::uvec3 numbers(0);
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!(step[axis] > 0.0f)) continue;
        const double number = std::round((static_cast<double>(value[axis]) - static_cast<double>(base[axis])) /
                                         static_cast<double>(step[axis]));
        // Written so that what is no number gives 0.
        if (number > 0.0)
            numbers[axis] = static_cast<std::uint32_t>(std::min(number, static_cast<double>(PackedTriple::largest)));
    }
    return PackedTriple::of(numbers, 0);
}

glm::vec3 CompactTracks::Range::unpack(const PackedTriple& packed) const
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

void CompactTracks::packTransform(std::size_t keyframe, const Track& track, JointTransform& transform)
{
    const auto at = [&](int column) -> PackedTriple&
    { return keyframes[keyframe * columnCount + static_cast<std::size_t>(column)]; };
    const auto packPart = [&](int column, const Range& range, glm::vec4& part)
    {
        if (column < 0) return;
        at(column) = range.pack(glm::vec3(part));
        part = glm::vec4(range.unpack(at(column)), 0.0f);
    };
    packPart(track.translation, track.translationRange, transform.translation);
    packPart(track.scale, track.scaleRange, transform.scale);
    if (track.rotation < 0) return;
    at(track.rotation) = PackedTriple::ofRotation(transform.rotation);
    transform.rotation = at(track.rotation).rotation();
}

} // namespace osgGpuAnimation
