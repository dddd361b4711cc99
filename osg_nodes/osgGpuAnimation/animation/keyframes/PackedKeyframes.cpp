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
/// In the order of a table's entry.
constexpr std::array<Part, 3> parts{&JointTransform::rotation, &JointTransform::translation, &JointTransform::scale};

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
        for (const Part part : {&JointTransform::translation, &JointTransform::rotation, &JointTransform::scale})
        {
            _constantAddresses.emplace(bits(rest.*part), static_cast<std::uint32_t>(_texels.size()));
            _texels.push_back(texel(rest.*part));
        }
    const auto table = static_cast<std::uint32_t>(_texels.size());
    for (const JointTransform& rest : set.restPose())
        _texels.emplace_back(addressOfConstant(rest.rotation), addressOfConstant(rest.translation),
                             addressOfConstant(rest.scale), 0u);
    if (!_texels.empty()) _texels.front() = {0u, 0u, table, 0u};
    for (std::size_t clip = 0; clip < set.clips().size(); ++clip)
        addClip(set.clips()[clip], set.firstKeyframe(clip));
}

void PackedKeyframes::addClip(const Clip& clip, std::size_t firstKeyframe)
{
    const CompactTracks* compact = clip.compactTracks();
    const std::size_t compactCount = compact ? compact->tracks.size() : 0;
    _table.assign(_set.trackCount(), glm::uvec4(0));
    _columns.clear();
    _recordSize = compact ? static_cast<std::uint32_t>(compact->recordSize) : 0;
    for (std::size_t track = 0; track < compactCount; ++track)
        placeCompactTrack(clip, track, compact->tracks[track]);
    for (std::size_t track = compactCount; track < _table.size(); ++track)
        placeTrack(clip, track);

    const auto table = static_cast<std::uint32_t>(_texels.size());
    _texels.insert(_texels.end(), _table.begin(), _table.end());
    const auto first = static_cast<std::uint32_t>(_texels.size());
    const std::size_t last = clip.keyframeCount() - 1;
    for (std::size_t k = 0; k <= last; ++k)
    {
        const auto next = static_cast<std::uint32_t>(std::min(k + 1, last));
        _texels[firstKeyframe + k] = {first + static_cast<std::uint32_t>(k) * _recordSize, first + next * _recordSize,
                                      table, 0u};
        if (compact)
        {
            const auto record = compact->records.begin() + k * compact->recordSize;
            _texels.insert(_texels.end(), record, record + compact->recordSize);
        }
        for (const Column& column : _columns)
            for (std::size_t i = 0; i < clip.transformsPerTrack(); ++i)
                _texels.push_back(texel(clip.at(k, column.track)[i].*column.part));
    }
}

/// Gives each part of the track its address: in the record if the part moves, else of a constant.
void PackedKeyframes::placeTrack(const Clip& clip, std::size_t track)
{
    std::array<bool, 3> isMoving{};
    for (std::size_t part = 0; part < parts.size(); ++part)
    {
        auto& place = _table[track][static_cast<glm::uvec4::length_type>(part)];
        isMoving[part] = moves(clip, track, parts[part]);
        place = isMoving[part] ? _recordSize : addressOfConstant(clip.at(0, track)->*parts[part]);
        if (!isMoving[part]) continue;
        _columns.push_back({track, parts[part]});
        _recordSize += static_cast<std::uint32_t>(clip.transformsPerTrack());
        _tracks[track].hasExactKeys = true;
    }
    widenMotion(clip, track, isMoving[1], isMoving[2]);
}

/// A track that does not move is placed like those of exact clips.
void PackedKeyframes::placeCompactTrack(const Clip& clip, std::size_t track, const CompactTracks::Track& compact)
{
    glm::uvec4& entry = _table[track];
    const JointTransform& value = *clip.at(0, track);
    const CompactTracks::RotationPart& rotation = compact.rotation;
    const bool movesVectors = compact.translation.isMoving() || compact.scale.isMoving();
    widenMotion(clip, track, compact.translation.isMoving(), compact.scale.isMoving());
    if (rotation.isMoving())
    {
        const auto bit = static_cast<std::uint32_t>(rotation.firstBit);
        const std::uint32_t texel = bit / CompactTracks::texelBits;
        const glm::uvec3 ranges = rotation.ranges | rotation.bits
                                                        << static_cast<std::uint32_t>(POSE_ROTATION_BITS_SHIFT);
        entry = {ranges.x | texel % 64u << POSE_ROTATION_PLACE_SHIFT,
                 ranges.y | bit % CompactTracks::texelBits << POSE_ROTATION_PLACE_SHIFT,
                 ranges.z | rotation.place << POSE_ROTATION_PLACE_SHIFT | texel / 64u << POSE_ROTATION_HIGH_SHIFT, 0u};
    }
    else
        entry = {addressOfConstant(value.rotation), 0u, 0u, 0u};
    if (rotation.isMoving() || movesVectors)
    {
        entry.w = addressOfVectors(clip, track, compact);
        _tracks[track].hasCompactKeys = true;
        return;
    }
    entry.y = addressOfConstant(value.translation);
    entry.z = addressOfConstant(value.scale);
}

void PackedKeyframes::widenMotion(const Clip& clip, std::size_t track, bool movesTranslation, bool movesScale)
{
    const JointTransform& value = *clip.at(0, track);
    const JointTransform& rest = _set.restPose()[track];
    const auto widen = [&](PartMotion& motion, bool isMoving, Part part)
    {
        if (isMoving) motion = PartMotion::Moving;
        if (motion == PartMotion::Fixed && bits(value.*part) != bits(rest.*part)) motion = PartMotion::Constant;
    };
    widen(_tracks[track].translation, movesTranslation, &JointTransform::translation);
    widen(_tracks[track].scale, movesScale, &JointTransform::scale);
}

std::uint32_t PackedKeyframes::addressOfConstant(const glm::vec4& value)
{
    const auto [known, isNew] = _constantAddresses.emplace(bits(value), static_cast<std::uint32_t>(_texels.size()));
    if (isNew) _texels.push_back(texel(value));
    return known->second | POSE_ADDRESS_IS_CONSTANT;
}

/// Never 0: in a table 0 marks an exact track.
std::uint32_t PackedKeyframes::addressOfVectors(const Clip& clip, std::size_t track,
                                                const CompactTracks::Track& compact)
{
    const JointTransform& value = *clip.at(0, track);
    const auto first = [](const CompactTracks::Part& part, const glm::vec4& constant)
    {
        glm::uvec4 words = texel(part.isMoving() ? glm::vec4(part.base, 0.0f) : constant);
        words.w = part.isMoving() ? static_cast<std::uint32_t>(part.firstBit) | POSE_VECTOR_MOVES : 0u;
        return words;
    };
    const auto second = [](const CompactTracks::Part& part)
    {
        glm::uvec4 words = texel(glm::vec4(part.step, 0.0f));
        words.w = part.bits.x | part.bits.y << POSE_VECTOR_BITS | part.bits.z << 2 * POSE_VECTOR_BITS;
        return words;
    };
    const std::array<glm::uvec4, 4> vectors{first(compact.translation, value.translation),
                                            first(compact.scale, value.scale), second(compact.translation),
                                            second(compact.scale)};
    std::array<std::uint32_t, 16> key{};
    std::memcpy(key.data(), vectors.data(), sizeof(key));
    const auto [known, isNew] = _vectorAddresses.emplace(key, static_cast<std::uint32_t>(_texels.size()));
    const bool isMoving = compact.translation.isMoving() || compact.scale.isMoving();
    if (isNew) _texels.insert(_texels.end(), vectors.begin(), vectors.begin() + (isMoving ? 4 : 2));
    return known->second;
}

} // namespace osgGpuAnimation
