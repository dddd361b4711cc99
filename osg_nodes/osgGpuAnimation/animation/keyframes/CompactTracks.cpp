// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>

#include <osgGpuAnimation/math/Rotation.h>

#include <layout.glsl>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

using CompactPart = CompactTracks::Part;
using CompactRotation = CompactTracks::RotationPart;

constexpr std::uint32_t rangeSteps = 1024; ///< values of 10 bits
constexpr auto rangeUnit = static_cast<float>(POSE_ROTATION_RANGE_UNIT);
constexpr auto fineUnit = static_cast<float>(POSE_ROTATION_FINE_UNIT);

std::uint32_t countOfBits(const CompactPart& part)
{
    return part.bits.x + part.bits.y + part.bits.z;
}

std::uint32_t countOfBits(const CompactRotation& part)
{
    return countOfBits(static_cast<const CompactPart&>(part)) + (part.place == CompactTracks::maxPlace ? 2u : 0u);
}

/// A run of bits of a record.
class BitRun
{
public:
    BitRun(glm::uvec4* record, std::int32_t firstBit) : _record(record), _bit(static_cast<std::uint32_t>(firstBit)) {}

    void write(std::uint32_t number, std::uint32_t count)
    {
        for (std::uint32_t i = 0; i < count; ++i, ++_bit)
            word() |= (number >> i & 1u) << _bit % 32;
    }
    std::uint32_t read(std::uint32_t count)
    {
        if (count == 0) return 0;
        const std::uint32_t shift = _bit % 32;
        std::uint64_t words = word() >> shift;
        if (shift + count > 32)
        {
            _bit += 32;
            words |= static_cast<std::uint64_t>(word()) << (32 - shift);
            _bit -= 32;
        }
        _bit += count;
        return static_cast<std::uint32_t>(words & ((std::uint64_t(1) << count) - 1));
    }

private:
    glm::uvec4::value_type& word() { return _record[_bit / CompactTracks::texelBits][static_cast<int>(_bit / 32 % 4)]; }

    glm::uvec4* _record;
    std::uint32_t _bit;
};

glm::uvec3 readNumbers(BitRun& run, const glm::uvec3& bits)
{
    glm::uvec3 numbers;
    for (int axis = 0; axis < 3; ++axis)
        numbers[axis] = run.read(bits[axis]);
    return numbers;
}

bool isSound(const CompactPart& part, std::uint32_t bits, std::size_t recordSize)
{
    if (!part.isMoving()) return part.firstBit == -1 && part.bits == glm::uvec3(0u);
    const auto first = static_cast<std::size_t>(part.firstBit);
    const glm::vec3 sum = glm::abs(part.base) + glm::abs(part.step);
    return glm::all(glm::lessThanEqual(part.bits, glm::uvec3(CompactTracks::maxBits))) &&
           first / CompactTracks::texelBits < recordSize &&
           first % CompactTracks::texelBits + bits <= CompactTracks::texelBits && std::isfinite(sum.x + sum.y + sum.z);
}

} // namespace

glm::uvec3 CompactTracks::Part::numbersOf(const glm::vec3& value) const
{
    glm::uvec3 numbers(0u);
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!(step[axis] > 0.0f)) continue;
        const double number = std::round((static_cast<double>(value[axis]) - static_cast<double>(base[axis])) /
                                         static_cast<double>(step[axis]));
        const auto max = static_cast<double>((1u << bits[axis]) - 1u);
        if (number > 0.0) numbers[axis] = static_cast<std::uint32_t>(std::min(number, max));
    }
    return numbers;
}

glm::vec3 CompactTracks::Part::valueOf(const glm::uvec3& numbers) const
{
    return base + step * glm::vec3(numbers);
}

void CompactTracks::Part::setRange(const glm::vec3& min, const glm::vec3& max, const glm::uvec3& newBits)
{
    bits = newBits;
    for (int axis = 0; axis < 3; ++axis)
    {
        const float extent = max[axis] - min[axis];
        step[axis] = bits[axis] == 0 ? 0.0f : extent / static_cast<float>((1u << bits[axis]) - 1u);
        base[axis] = bits[axis] == 0 ? min[axis] + 0.5f * extent : min[axis];
    }
}

void CompactTracks::RotationPart::setRange(const glm::vec3& min, const glm::vec3& max, const glm::uvec3& newBits)
{
    const auto unitsOf = [](float units, float limit)
    { return static_cast<std::uint32_t>(std::clamp(units, 0.0f, limit)); };
    bits = newBits;
    glm::uvec3 newRanges;
    for (int axis = 0; axis < 3; ++axis)
    {
        constexpr auto maxUnits = static_cast<float>(rangeSteps - 1);
        const std::uint32_t first = unitsOf(std::floor((min[axis] + 1.0f) / rangeUnit), maxUnits);
        const float begin = static_cast<float>(first) * rangeUnit - 1.0f;
        const std::uint32_t extent = unitsOf(std::ceil((max[axis] - begin) / rangeUnit) - 1.0f, maxUnits);
        const float middle = 0.5f * (min[axis] + max[axis]);
        newRanges[axis] = bits[axis] > 0 ? first | extent << 10
                                         : unitsOf(std::round((middle + 1.0f) / fineUnit), 2.0f / fineUnit - 1.0f);
    }
    setRanges(newRanges);
}

void CompactTracks::RotationPart::setRanges(const glm::uvec3& newRanges)
{
    ranges = newRanges;
    for (int axis = 0; axis < 3; ++axis)
    {
        const float extent = static_cast<float>((ranges[axis] >> 10) + 1u) * rangeUnit;
        const float min = static_cast<float>(ranges[axis] & (rangeSteps - 1u)) * rangeUnit - 1.0f;
        step[axis] = bits[axis] == 0 ? 0.0f : std::ldexp(extent, -static_cast<int>(std::min(bits[axis], maxBits)));
        base[axis] = bits[axis] == 0 ? static_cast<float>(ranges[axis]) * fineUnit - 1.0f : min + 0.5f * step[axis];
    }
}

glm::vec3 CompactTracks::componentsOf(const glm::vec4& rotation, std::uint32_t& place)
{
    glm::dvec4 unit = Rotation::unit(glm::dvec4(rotation));
    if (place == maxPlace)
    {
        place = 0;
        for (int i = 1; i < 4; ++i)
            if (std::abs(unit[i]) > std::abs(unit[static_cast<int>(place)])) place = static_cast<std::uint32_t>(i);
    }
    if (unit[static_cast<int>(place)] < 0.0) unit = -unit;
    glm::vec3 components;
    for (int i = 0, next = 0; i < 4; ++i)
        if (i != static_cast<int>(place)) components[next++] = static_cast<float>(unit[i]);
    return components;
}

glm::vec4 CompactTracks::rotationOf(const glm::vec3& v, std::uint32_t place)
{
    const float rest = std::sqrt(std::max(1.0f - (v.x * v.x + v.y * v.y + v.z * v.z), 0.0f));
    switch (place)
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

void CompactTracks::round(const Track& track, JointTransform& transform)
{
    const auto rounded = [](const Part& part, const glm::vec3& value) { return part.valueOf(part.numbersOf(value)); };
    if (track.translation.isMoving())
        transform.translation = glm::vec4(rounded(track.translation, glm::vec3(transform.translation)), 0.0f);
    if (track.scale.isMoving()) transform.scale = glm::vec4(rounded(track.scale, glm::vec3(transform.scale)), 0.0f);
    if (!track.rotation.isMoving()) return;
    std::uint32_t place = track.rotation.place;
    const glm::vec3 components = componentsOf(transform.rotation, place);
    transform.rotation = rotationOf(rounded(track.rotation, components), place);
}

/// First fit, the largest parts first.
bool CompactTracks::placeParts()
{
    struct Run
    {
        Part* part;
        std::uint32_t bits;
    };
    std::vector<Run> runs;
    for (Track& track : tracks)
    {
        if (track.translation.isMoving()) runs.push_back({&track.translation, countOfBits(track.translation)});
        if (track.rotation.isMoving()) runs.push_back({&track.rotation, countOfBits(track.rotation)});
        if (track.scale.isMoving()) runs.push_back({&track.scale, countOfBits(track.scale)});
    }
    std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.bits > b.bits; });
    std::vector<std::uint32_t> used; // bits of each texel
    for (const Run& run : runs)
    {
        const auto fits = [&](std::uint32_t bits) { return bits + run.bits <= texelBits; };
        auto texel = std::find_if(used.begin(), used.end(), fits);
        if (texel == used.end()) texel = used.insert(texel, 0u);
        const auto index = static_cast<std::size_t>(texel - used.begin());
        // A part without bits may lie at the end of a full texel: it reads none of its bits.
        run.part->firstBit =
            static_cast<std::int32_t>(index * texelBits + std::min<std::size_t>(*texel, texelBits - 1));
        *texel += run.bits;
    }
    recordSize = used.size();
    return recordSize <= maxTexels;
}

bool CompactTracks::pack(std::vector<JointTransform>& data, std::size_t trackCount)
{
    if (!placeParts()) return false;
    const std::size_t keyframeCount = trackCount == 0 ? 0 : data.size() / trackCount;
    records.assign(keyframeCount * recordSize, glm::uvec4(0u));
    for (std::size_t k = 0; k < keyframeCount; ++k)
        for (std::size_t joint = 0; joint < tracks.size(); ++joint)
        {
            const JointTransform& transform = data[k * trackCount + joint];
            glm::uvec4* record = records.data() + k * recordSize;
            const auto write = [&](const Part& part, const glm::vec3& value)
            {
                BitRun run(record, part.firstBit);
                const glm::uvec3 numbers = part.numbersOf(value);
                for (int axis = 0; axis < 3; ++axis)
                    run.write(numbers[axis], part.bits[axis]);
                return run;
            };
            const Track& track = tracks[joint];
            if (track.translation.isMoving()) write(track.translation, glm::vec3(transform.translation));
            if (track.scale.isMoving()) write(track.scale, glm::vec3(transform.scale));
            if (!track.rotation.isMoving()) continue;
            std::uint32_t place = track.rotation.place;
            BitRun run = write(track.rotation, componentsOf(transform.rotation, place));
            if (track.rotation.place == maxPlace) run.write(place, 2);
        }
    unpack(data, trackCount);
    return true;
}

bool CompactTracks::isFor(std::size_t jointCount, std::size_t keyframeCount) const
{
    const auto isSoundRotation = [&](const RotationPart& part)
    {
        return isSound(part, countOfBits(part), recordSize) && part.place <= maxPlace &&
               glm::all(glm::lessThan(part.ranges, glm::uvec3(rangeSteps * rangeSteps)));
    };
    const auto areSound = [&](const Track& track)
    {
        return isSound(track.translation, countOfBits(track.translation), recordSize) &&
               isSoundRotation(track.rotation) && isSound(track.scale, countOfBits(track.scale), recordSize);
    };
    return tracks.size() == jointCount && recordSize <= maxTexels && records.size() == recordSize * keyframeCount &&
           std::all_of(tracks.begin(), tracks.end(), areSound);
}

void CompactTracks::unpack(std::vector<JointTransform>& data, std::size_t trackCount) const
{
    const std::size_t keyframeCount = trackCount == 0 ? 0 : data.size() / trackCount;
    std::vector<glm::uvec4> record(recordSize);
    for (std::size_t k = 0; k < keyframeCount; ++k)
    {
        std::copy_n(records.begin() + k * recordSize, recordSize, record.begin());
        for (std::size_t joint = 0; joint < tracks.size(); ++joint)
        {
            const Track& track = tracks[joint];
            JointTransform& transform = data[k * trackCount + joint];
            const auto read = [&](const Part& part)
            {
                BitRun run(record.data(), part.firstBit);
                return glm::vec4(part.valueOf(readNumbers(run, part.bits)), 0.0f);
            };
            if (track.translation.isMoving()) transform.translation = read(track.translation);
            if (track.scale.isMoving()) transform.scale = read(track.scale);
            if (!track.rotation.isMoving()) continue;
            BitRun run(record.data(), track.rotation.firstBit);
            const glm::uvec3 numbers = readNumbers(run, track.rotation.bits);
            const std::uint32_t place = track.rotation.place == maxPlace ? run.read(2) : track.rotation.place;
            transform.rotation = rotationOf(track.rotation.valueOf(numbers), place);
        }
    }
}

} // namespace osgGpuAnimation
