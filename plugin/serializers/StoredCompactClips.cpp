// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::size_t wordsATrack = 34; // integers, and the bits of floats
static_assert(sizeof(CompactTracks::Track) == wordsATrack * sizeof(std::uint32_t), "a track has 32-bit numbers alone");

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

} // namespace

void transferCompactKeyframes(ValueStream& stream, ClipParts& clip, std::size_t& bytesLeft)
{
    CompactParts compact;
    if (!stream.isReading()) compact = toCompactParts(clip);
    stream.block<std::uint32_t>("Compact", compact.tracks.tracks, wordsATrack);
    stream.block("Held", compact.held, floatsATransform);
    stream.block("Weights", compact.weights, floatsATransform);
    stream.property("RecordSize").value(compact.tracks.recordSize).endLine();
    stream.block<std::uint32_t>("Records", compact.tracks.records, 8); // by keyframe, then by texel
    if (!stream.hasRead()) return;
    stream.require("", fillKeyframes(compact, clip, bytesLeft));
    if (!stream.isGood()) return;
    for (CompactTracks::Track& track : compact.tracks.tracks)
        if (track.rotation.isMoving()) track.rotation.setRanges(track.rotation.ranges);
    clip.compactTracks = std::make_shared<const CompactTracks>(std::move(compact.tracks));
}

} // namespace osgGpuAnimation::serializers
