// SPDX-License-Identifier: MIT
#include "serializers/StoredCompactTracks.h"

#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <osgGpuAnimation/animation/CompactTracks.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::size_t floatsATransform = sizeof(JointTransform) / sizeof(float);
constexpr float placeUnit = static_cast<float>(PackedTriple::largest) + 1.0f;

void append(std::vector<float>& floats, const JointTransform* first, std::size_t count)
{
    const float* numbers = &first->translation.x;
    floats.insert(floats.end(), numbers, numbers + count * floatsATransform);
}

void writeBlock(ValueWriter& out, const char* name, const std::vector<float>& floats, std::size_t perLine)
{
    out.block(name, floats.data(), floats.size(), perLine);
}

std::vector<float> packedNumbers(const std::vector<PackedTriple>& keyframes)
{
    std::vector<float> floats;
    floats.reserve(3 * keyframes.size());
    for (const PackedTriple& triple : keyframes)
    {
        const glm::vec3 numbers(triple.numbers());
        floats.insert(floats.end(), {numbers.x, numbers.y, numbers.z + placeUnit * static_cast<float>(triple.place())});
    }
    return floats;
}

/// Anything that is no such number becomes the nearest.
std::uint32_t wholeNumber(float number, float largest)
{
    return number > 0.0f ? static_cast<std::uint32_t>(std::min(number, largest)) : 0u;
}

std::vector<PackedTriple> toTriples(const std::vector<float>& floats)
{
    constexpr auto largest = static_cast<float>(PackedTriple::largest);
    std::vector<PackedTriple> triples(floats.size() / 3);
    for (std::size_t i = 0; i < triples.size(); ++i)
    {
        const std::uint32_t last = wholeNumber(floats[3 * i + 2], 4.0f * placeUnit - 1.0f);
        triples[i] = PackedTriple::of({wholeNumber(floats[3 * i], largest), wholeNumber(floats[3 * i + 1], largest),
                                       last & PackedTriple::largest},
                                      last >> 20);
    }
    return triples;
}

void writeTracks(ValueWriter& out, const CompactTracks& compact)
{
    out.open("Compact", compact.tracks.size());
    for (const CompactTracks::Track& track : compact.tracks)
    {
        out.property("Track").integer(track.translation).integer(track.rotation).integer(track.scale);
        for (const CompactTracks::Range& range : {track.translationRange, track.scaleRange})
            out.floats(&range.base.x, 3).floats(&range.step.x, 3);
        out.endLine();
    }
    out.close();
}

std::vector<CompactTracks::Track> readTracks(ValueReader& in)
{
    std::vector<CompactTracks::Track> tracks;
    const std::size_t count = in.open("Compact");
    for (std::size_t i = 0; i < count && in.isGood(); ++i)
    {
        CompactTracks::Track track;
        track.translation = in.property("Track").integer();
        track.rotation = in.integer();
        track.scale = in.integer();
        for (CompactTracks::Range* range : {&track.translationRange, &track.scaleRange})
        {
            in.floats(&range->base.x, 3);
            in.floats(&range->step.x, 3);
        }
        tracks.push_back(track);
    }
    in.close();
    return tracks;
}

/// What the joints hold at all keyframes, and the weights: what moves is still to come.
std::vector<JointTransform> spread(const std::vector<float>& held, const std::vector<float>& weights,
                                   const ClipParts& parts)
{
    std::vector<JointTransform> data(parts.times.size() * parts.trackCount);
    const std::size_t weightFloats = (parts.trackCount - parts.jointCount) * floatsATransform;
    for (std::size_t k = 0; k < parts.times.size() && !data.empty(); ++k)
    {
        JointTransform* keyframe = &data[k * parts.trackCount];
        if (!held.empty()) std::copy(held.begin(), held.end(), &keyframe->translation.x);
        const auto first = weights.begin() + static_cast<std::ptrdiff_t>(k * weightFloats);
        if (weightFloats > 0) std::copy_n(first, weightFloats, &keyframe[parts.jointCount].translation.x);
    }
    return data;
}

} // namespace

void writeCompactKeyframes(ValueWriter& out, const Clip& clip)
{
    const CompactTracks& compact = *clip.compactTracks();
    const std::size_t joints = compact.tracks.size();
    std::vector<float> held, weights;
    if (joints > 0) append(held, clip.data().data(), joints);
    for (std::size_t k = 0; k < clip.keyframeCount() && clip.trackCount() > joints; ++k)
        append(weights, &clip.data()[k * clip.trackCount() + joints], clip.trackCount() - joints);
    writeTracks(out, compact);
    writeBlock(out, "Held", held, floatsATransform);
    writeBlock(out, "Weights", weights, floatsATransform);
    writeBlock(out, "Packed", packedNumbers(compact.keyframes), 3 * std::max<std::size_t>(compact.columnCount, 1));
}

void readCompactKeyframes(ValueReader& in, ClipParts& parts, std::size_t& bytesLeft)
{
    auto compact = std::make_shared<CompactTracks>();
    compact->tracks = readTracks(in);
    const std::vector<float> held = in.block("Held"), weights = in.block("Weights"), packed = in.block("Packed");
    if (!in.isGood()) return;
    const std::size_t keyframes = parts.times.size(), weightTracks = parts.trackCount - parts.jointCount;
    if (held.size() != parts.jointCount * floatsATransform || packed.size() % 3 != 0 ||
        weights.size() != keyframes * weightTracks * floatsATransform)
        return in.fail("clip \"" + parts.name + "\": the numbers of its compact keyframes are not those of the clip");
    if (parts.trackCount > 0 && keyframes > bytesLeft / sizeof(JointTransform) / parts.trackCount)
        return in.fail("clip \"" + parts.name + "\" would be larger than keyframes may be in memory");
    bytesLeft -= keyframes * parts.trackCount * sizeof(JointTransform);
    compact->keyframes = toTriples(packed);
    compact->columnCount = keyframes == 0 ? 0 : compact->keyframes.size() / keyframes;
    parts.data = spread(held, weights, parts);
    parts.compactTracks = std::move(compact);
}

} // namespace osgGpuAnimation::serializers
