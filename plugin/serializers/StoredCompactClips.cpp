// SPDX-License-Identifier: MIT
#include "serializers/StoredCompactClips.h"

#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::size_t floatsATransform = sizeof(JointTransform) / sizeof(float);

/// The keyframes of a compact clip as the file has them.
struct CompactParts
{
    CompactTracks tracks;
    std::vector<JointTransform> held;    ///< one per joint: the values of joints at rest
    std::vector<JointTransform> weights; ///< by keyframe: the weight blocks
};

CompactParts toCompactParts(const ClipParts& clip)
{
    CompactParts compact{*clip.compactTracks, {}, {}};
    const auto joints = static_cast<std::ptrdiff_t>(clip.jointCount);
    const auto tracks = static_cast<std::ptrdiff_t>(clip.trackCount);
    compact.held.assign(clip.data.begin(), clip.data.begin() + joints);
    for (auto keyframe = clip.data.begin(); tracks > 0 && keyframe != clip.data.end(); keyframe += tracks)
        compact.weights.insert(compact.weights.end(), keyframe + joints, keyframe + tracks);
    return compact;
}

/// Fills data with the transforms at rest and the weights. Subtracts the bytes of the keyframes from bytesLeft. Error:
/// the parts do not fit each other or exceed bytesLeft.
Result<bool> fillKeyframes(const CompactParts& compact, ClipParts& clip, std::size_t& bytesLeft)
{
    const std::size_t keyframes = clip.times.size(), weightTracks = clip.trackCount - clip.jointCount;
    if (compact.held.size() != clip.jointCount || compact.weights.size() != keyframes * weightTracks)
        return Error{"clip \"" + clip.name + "\": the numbers of its compact keyframes are not those of the clip"};
    if (clip.trackCount > 0 && keyframes > bytesLeft / sizeof(JointTransform) / clip.trackCount)
        return Error{"clip \"" + clip.name + "\": its keyframes would exceed the memory for compact clips"};
    bytesLeft -= keyframes * clip.trackCount * sizeof(JointTransform);
    clip.data.reserve(keyframes * clip.trackCount);
    for (auto weights = compact.weights.begin(); clip.data.size() < keyframes * clip.trackCount;)
    {
        clip.data.insert(clip.data.end(), compact.held.begin(), compact.held.end());
        clip.data.insert(clip.data.end(), weights, weights + static_cast<std::ptrdiff_t>(weightTracks));
        weights += static_cast<std::ptrdiff_t>(weightTracks);
    }
    return true;
}

/// Packing would replace numbers that are not finite.
Result<bool> checkFinite(const ClipParts& clip)
{
    const bool isFinite = std::all_of(clip.data.begin(), clip.data.end(),
                                      [](const JointTransform& transform) { return transform.isFinite(); });
    if (isFinite) return true;
    return Error{"clip \"" + clip.name + "\": a number of its compact keyframes is not finite"};
}

void transferWords(ValueStream& stream, glm::uvec3& words)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        auto integer = static_cast<std::int32_t>(words[axis]);
        stream.value(integer);
        words[axis] = static_cast<std::uint32_t>(integer);
    }
}

void transferTrack(ValueStream& stream, CompactTracks::Track& track)
{
    stream.property("Track").value(track.rotation.firstBit);
    transferWords(stream, track.rotation.bits);
    transferWords(stream, track.rotation.ranges);
    auto place = static_cast<std::int32_t>(track.rotation.place);
    stream.value(place);
    track.rotation.place = static_cast<std::uint32_t>(place);
    for (CompactTracks::Part* part : {&track.translation, &track.scale})
    {
        stream.value(part->firstBit);
        transferWords(stream, part->bits);
        stream.floats(&part->base.x, 3).floats(&part->step.x, 3);
    }
    stream.endLine();
}

/// The records as 32-bit words: by keyframe, then by texel.
void transferRecords(ValueStream& stream, CompactTracks& tracks)
{
    stream.property("RecordSize").value(tracks.recordSize).endLine();
    stream.list("Records", tracks.records,
                [&](glm::uvec4& texel)
                {
                    for (int word = 0; word < 4; ++word)
                    {
                        std::int32_t integer = 0;
                        std::memcpy(&integer, &texel[word], sizeof(integer));
                        stream.value(integer);
                        std::memcpy(&texel[word], &integer, sizeof(integer));
                    }
                    stream.endLine();
                });
}

/// Columns of three numbers of 20 bits, one for each part that moves. They are decoded and packed again, with as many
/// bits.
class FormerCompactKeyframes
{
public:
    static void read(ValueStream& stream, ClipParts& clip, std::size_t& bytesLeft)
    {
        FormerCompactKeyframes former;
        stream.list("Compact", former._tracks, [&](Track& track) { transferTrack(stream, track); });
        CompactParts parts;
        stream.block("Held", parts.held, floatsATransform);
        stream.block("Weights", parts.weights, floatsATransform);
        stream.block("Packed", former._packed, 3);
        if (!stream.hasRead()) return;
        stream.require("", former.fit(clip));
        if (stream.isGood()) stream.require("", fillKeyframes(parts, clip, bytesLeft));
        if (!stream.isGood()) return;
        former.decode(clip);
        stream.require("", checkFinite(clip));
        if (!stream.isGood()) return;
        CompactTracks tracks = CompactTracks::finest(clip.data, clip.trackCount, clip.jointCount);
        // A record that would be too large leaves the clip exact.
        if (tracks.pack(clip.data, clip.trackCount))
            clip.compactTracks = std::make_shared<const CompactTracks>(std::move(tracks));
    }

private:
    static constexpr float largest = 1048575.0f, placeUnit = 1048576.0f; ///< 20 bits
    static constexpr float rotationZero = 524288.0f, rotationStep = 1.348702e-6f;

    /// A translation or a scale: value = base + step * number, axis by axis.
    struct Range
    {
        glm::vec3 base{0.0f}, step{0.0f};
    };
    /// Columns of a keyframe; -1: the part is constant.
    struct Track
    {
        std::int32_t translation = -1, rotation = -1, scale = -1;
        Range translationRange, scaleRange;
    };

    static void transferTrack(ValueStream& stream, Track& track)
    {
        stream.property("Track").values(track.translation, track.rotation, track.scale);
        for (Range* range : {&track.translationRange, &track.scaleRange})
            stream.floats(&range->base.x, 3).floats(&range->step.x, 3);
        stream.endLine();
    }

    Result<bool> fit(const ClipParts& clip)
    {
        const std::size_t keyframes = clip.times.size();
        _columnCount = keyframes == 0 ? 0 : _packed.size() / 3 / keyframes;
        bool isFit = clip.form == Clip::Form::Linear && _tracks.size() == clip.jointCount &&
                     _packed.size() == 3 * _columnCount * keyframes;
        for (const Track& track : _tracks)
            for (const std::int32_t column : {track.translation, track.rotation, track.scale})
                isFit = isFit && column >= -1 && (column < 0 || static_cast<std::size_t>(column) < _columnCount);
        if (isFit) return true;
        return Error{"clip \"" + clip.name + "\": its compact keyframes do not fit the clip"};
    }

    void decode(ClipParts& clip) const
    {
        for (std::size_t k = 0; k < clip.times.size(); ++k)
            for (std::size_t joint = 0; joint < _tracks.size(); ++joint)
            {
                const Track& track = _tracks[joint];
                JointTransform& transform = clip.data[k * clip.trackCount + joint];
                std::uint32_t place = 0;
                const auto vectorAt = [&](std::int32_t column, const Range& range)
                { return glm::vec4(range.base + range.step * numbers(k, column, place), 0.0f); };
                if (track.translation >= 0) transform.translation = vectorAt(track.translation, track.translationRange);
                if (track.scale >= 0) transform.scale = vectorAt(track.scale, track.scaleRange);
                if (track.rotation < 0) continue;
                const glm::vec3 components = (numbers(k, track.rotation, place) - rotationZero) * rotationStep;
                transform.rotation = CompactTracks::rotationOf(components, place);
            }
    }

    /// The file has x, y and z + place * 2^20. Returns whole numbers in [0, largest]; 0 for NaN.
    glm::vec3 numbers(std::size_t keyframe, std::int32_t column, std::uint32_t& outPlace) const
    {
        const auto whole = [](float number, float most) { return std::floor(std::min(std::max(0.0f, number), most)); };
        const float* packed = &_packed[3 * (keyframe * _columnCount + static_cast<std::size_t>(column))];
        const float last = whole(packed[2], 4.0f * placeUnit - 1.0f);
        outPlace = static_cast<std::uint32_t>(last / placeUnit);
        return {whole(packed[0], largest), whole(packed[1], largest), last - static_cast<float>(outPlace) * placeUnit};
    }

    std::vector<Track> _tracks; ///< one per joint
    std::vector<float> _packed;
    std::size_t _columnCount = 0;
};

} // namespace

void transferCompactKeyframes(ValueStream& stream, ClipParts& clip, std::size_t& bytesLeft)
{
    CompactParts compact;
    if (!stream.isReading()) compact = toCompactParts(clip);
    stream.list("Compact", compact.tracks.tracks, [&](CompactTracks::Track& track) { transferTrack(stream, track); });
    stream.block("Held", compact.held, floatsATransform);
    stream.block("Weights", compact.weights, floatsATransform);
    transferRecords(stream, compact.tracks);
    if (!stream.hasRead()) return;
    stream.require("", fillKeyframes(compact, clip, bytesLeft));
    if (!stream.isGood()) return;
    for (CompactTracks::Track& track : compact.tracks.tracks)
        track.rotation.setRanges(track.rotation.ranges);
    clip.compactTracks = std::make_shared<const CompactTracks>(std::move(compact.tracks));
}

void readFormerCompactKeyframes(ValueStream& stream, ClipParts& clip, std::size_t& bytesLeft)
{
    FormerCompactKeyframes::read(stream, clip, bytesLeft);
}

} // namespace osgGpuAnimation::serializers
