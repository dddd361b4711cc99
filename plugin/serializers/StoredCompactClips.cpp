// SPDX-License-Identifier: MIT
#include "serializers/StoredCompactClips.h"

#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>

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
Result<void> fillKeyframes(const CompactParts& compact, ClipParts& clip, std::size_t& bytesLeft)
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
    return {};
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

} // namespace osgGpuAnimation::serializers
