// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>

#include <layout.glsl>

#include <algorithm>
#include <cstring>

namespace osgGpuAnimation
{

namespace
{

using Part = glm::vec4 JointTransform::*;
constexpr std::array<Part, 3> parts{&JointTransform::translation, &JointTransform::rotation, &JointTransform::scale};

std::array<std::uint32_t, 4> bits(const glm::vec4& value)
{
    std::array<std::uint32_t, 4> words;
    std::memcpy(words.data(), &value, sizeof(words));
    return words;
}

glm::uvec4 texel(const glm::vec4& value)
{
    const std::array<std::uint32_t, 4> words = bits(value);
    return {words[0], words[1], words[2], words[3]};
}

bool moves(const Clip& clip, std::size_t track, Part part)
{
    const std::size_t perTrack = clip.transformsPerTrack();
    const JointTransform* first = clip.at(0, track);
    for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
    {
        const JointTransform* here = first + k * clip.keyframeStride();
        if (bits(here->*part) != bits(first->*part)) return true;
        for (std::size_t tangent = 1; tangent < perTrack; ++tangent)
            if (here[tangent].*part != glm::vec4(0.0f)) return true;
    }
    return false;
}

} // namespace

PackedKeyframes::PackedKeyframes(const AnimationSet& set) : _set(set), _tracks(set.trackCount())
{
    _texels.resize(set.keyframeCount());
    _restTexel = _texels.size();
    for (const JointTransform& rest : set.restPose())
        for (const Part part : parts)
        {
            _constantAddresses.emplace(bits(rest.*part), static_cast<std::uint32_t>(2 * _texels.size()));
            _texels.push_back(texel(rest.*part));
        }
    const auto table = static_cast<std::uint32_t>(_texels.size());
    for (const JointTransform& rest : set.restPose())
        _texels.emplace_back(addressOfConstant(rest.translation), addressOfConstant(rest.rotation),
                             addressOfConstant(rest.scale), 0u);
    if (!_texels.empty()) _texels.front() = {0u, 0u, table, 0u};
    for (std::size_t clip = 0; clip < set.clips().size(); ++clip)
        addClip(set.clips()[clip], set.firstKeyframe(clip));
}

void PackedKeyframes::addClip(const Clip& clip, std::size_t firstKeyframe)
{
    _table.assign(_set.trackCount(), glm::uvec4(0));
    _columns.clear();
    _recordSize = 0;
    const std::size_t compactCount = clip.compactTracks() ? clip.compactTracks()->tracks.size() : 0;
    for (std::size_t track = compactCount; track < _table.size(); ++track)
        placeTrack(clip, track, nullptr);
    const bool hasExactColumns = !_columns.empty();
    for (std::size_t track = 0; track < compactCount; ++track)
        placeTrack(clip, track, &clip.compactTracks()->tracks[track]);
    // Exact values must begin at whole texels in every record.
    if (hasExactColumns) _recordSize += _recordSize % 2;

    const auto table = static_cast<std::uint32_t>(_texels.size());
    _texels.insert(_texels.end(), _table.begin(), _table.end());
    const auto first = static_cast<std::uint32_t>(2 * _texels.size());
    const std::size_t last = clip.keyframeCount() - 1;
    std::vector<std::uint32_t> words;
    words.reserve(2 * (last + 1) * _recordSize);
    for (std::size_t k = 0; k <= last; ++k)
    {
        const auto next = static_cast<std::uint32_t>(std::min(k + 1, last));
        _texels[firstKeyframe + k] = {first + static_cast<std::uint32_t>(k) * _recordSize, first + next * _recordSize,
                                      table, 0u};
        writeRecord(clip, k, words);
        words.resize(2 * (k + 1) * _recordSize);
    }
    words.resize((words.size() + 3) / 4 * 4);
    for (std::size_t word = 0; word < words.size(); word += 4)
        _texels.emplace_back(words[word], words[word + 1], words[word + 2], words[word + 3]);
}

/// Gives each part of the track its address: in the record if the part moves, else of a constant. compact: null for an
/// exact track.
void PackedKeyframes::placeTrack(const Clip& clip, std::size_t track, const CompactTracks::Track* compact)
{
    glm::uvec4& entry = _table[track];
    std::array<int, 3> columns{-1, -1, -1};
    if (compact) columns = {compact->translation, compact->rotation, compact->scale};
    for (std::size_t part = 0; part < parts.size(); ++part)
    {
        auto& place = entry[static_cast<glm::uvec4::length_type>(part)];
        if (compact ? columns[part] < 0 : !moves(clip, track, parts[part]))
        {
            place = addressOfConstant(clip.at(0, track)->*parts[part]);
            continue;
        }
        place = _recordSize;
        _columns.push_back({track, parts[part], columns[part]});
        _recordSize += compact ? 1u : static_cast<std::uint32_t>(2 * clip.transformsPerTrack());
        (compact ? _tracks[track].hasCompactKeys : _tracks[track].hasExactKeys) = true;
    }
    if (compact) entry.w = ranges(*compact);
    widenMotion(clip, track, entry);
}

void PackedKeyframes::widenMotion(const Clip& clip, std::size_t track, const glm::uvec4& places)
{
    const JointTransform& value = *clip.at(0, track);
    const JointTransform& rest = _set.restPose()[track];
    const auto widen = [&](PartMotion& motion, std::uint32_t place, Part part)
    {
        if ((place & POSE_ADDRESS_IS_CONSTANT) == 0u) motion = PartMotion::Moving;
        if (motion == PartMotion::Fixed && bits(value.*part) != bits(rest.*part)) motion = PartMotion::Constant;
    };
    widen(_tracks[track].translation, places.x, &JointTransform::translation);
    widen(_tracks[track].scale, places.z, &JointTransform::scale);
}

void PackedKeyframes::writeRecord(const Clip& clip, std::size_t keyframe, std::vector<std::uint32_t>& words) const
{
    const std::size_t perTrack = clip.transformsPerTrack();
    for (const Column& column : _columns)
    {
        if (column.compact >= 0)
        {
            const CompactTracks& compact = *clip.compactTracks();
            const std::size_t place = keyframe * compact.columnCount + static_cast<std::size_t>(column.compact);
            words.insert(words.end(), {compact.keyframes[place].low, compact.keyframes[place].high});
            continue;
        }
        const JointTransform* transform = clip.at(keyframe, column.track);
        for (std::size_t i = 0; i < perTrack; ++i)
        {
            const std::array<std::uint32_t, 4> number = bits(transform[i].*column.part);
            words.insert(words.end(), number.begin(), number.end());
        }
    }
}

std::uint32_t PackedKeyframes::addressOfConstant(const glm::vec4& value)
{
    const auto [known, isNew] = _constantAddresses.emplace(bits(value), static_cast<std::uint32_t>(2 * _texels.size()));
    if (isNew) _texels.push_back(texel(value));
    return known->second | POSE_ADDRESS_IS_CONSTANT;
}

/// Never 0: in a table 0 marks an exact track.
std::uint32_t PackedKeyframes::ranges(const CompactTracks::Track& track)
{
    const CompactTracks::Range& t = track.translationRange;
    const CompactTracks::Range& s = track.scaleRange;
    const std::array<float, 12> key{t.base.x, t.base.y, t.base.z, t.step.x, t.step.y, t.step.z,
                                    s.base.x, s.base.y, s.base.z, s.step.x, s.step.y, s.step.z};
    const auto [known, isNew] = _rangeTexels.emplace(key, static_cast<std::uint32_t>(_texels.size()));
    if (isNew)
        for (const glm::vec3& numbers : {t.base, t.step, s.base, s.step})
            _texels.push_back(texel(glm::vec4(numbers, 0.0f)));
    return known->second;
}

} // namespace osgGpuAnimation
