// SPDX-License-Identifier: MIT
#include "gltf/export/ClipKeys.h"

#include <osgGpuAnimation/math/Hermite.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t numbersOfTrack = 12;
constexpr std::size_t maxKeysOfPiece = 256; ///< bounds the time of joinedPieces(), the square of it

/// One keyframe of a property.
struct PropertyKey
{
    float time = 0.0f;
    std::vector<float> value;
    std::vector<float> in, out; ///< slopes, as glTF's tangents are; empty: no spline
};

/// False for a slerped rotation of a Spline clip, see Clip.
bool isSplineOf(const Clip& clip, const ClipProperty& property)
{
    return clip.form() == Clip::Form::Spline &&
           !(property.isRotation && clip.at(0, property.track)->translation.w == 1.0f);
}

std::vector<PropertyKey> allKeysOf(const Clip& clip, const ClipProperty& property)
{
    std::vector<PropertyKey> made;
    for (std::size_t keyframe = 0; keyframe < clip.keyframeCount(); ++keyframe)
    {
        const auto part = [&](std::size_t number)
        {
            std::vector<float> numbers;
            for (std::size_t at = property.firstNumber; at < property.firstNumber + property.count; ++at)
                numbers.push_back(
                    clip.at(keyframe, property.track + at / numbersOfTrack)[number].number(at % numbersOfTrack));
            return numbers;
        };
        // A clip's tangents are multiplied by the length of their interval.
        const auto slopes = [&](std::size_t number, std::size_t from, std::size_t to)
        {
            const bool isInterval = from < to && to < clip.keyframeCount();
            const double length = isInterval ? static_cast<double>(clip.times()[to]) - clip.times()[from] : 0.0;
            std::vector<float> numbers = part(number);
            for (float& tangent : numbers)
                tangent = length > 0.0 ? static_cast<float>(tangent / length) : 0.0f;
            return numbers;
        };
        made.push_back({clip.times()[keyframe], part(0), {}, {}});
        if (!isSplineOf(clip, property)) continue;
        made.back().in = slopes(1, keyframe - 1, keyframe);
        made.back().out = slopes(2, keyframe, keyframe + 1);
    }
    return made;
}

/// Where two keyframes have one time, the first is one float earlier; where that is no room, it is left out.
std::vector<PropertyKey> withoutJumps(std::vector<PropertyKey> keys)
{
    std::vector<PropertyKey> made;
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
        PropertyKey& key = keys[i];
        if (i + 1 < keys.size() && keys[i + 1].time == key.time)
        {
            if (keys[i + 1].value == key.value && key.in.empty()) continue;
            key.time = std::nextafter(key.time, -1.0f);
            if (key.time < 0.0f || (!made.empty() && made.back().time >= key.time)) continue;
        }
        made.push_back(std::move(key));
    }
    return made;
}

bool isHeld(const std::vector<PropertyKey>& keys)
{
    for (std::size_t i = 0; i + 1 < keys.size(); ++i)
        if (keys[i].time < keys[i + 1].time && keys[i].value != keys[i + 1].value) return false;
    const auto isFlat = [](const PropertyKey& key)
    {
        const auto isZero = [](float number) { return number == 0.0f; };
        return std::all_of(key.in.begin(), key.in.end(), isZero) && std::all_of(key.out.begin(), key.out.end(), isZero);
    };
    return std::all_of(keys.begin(), keys.end(), isFlat);
}

std::vector<PropertyKey> changesOf(const std::vector<PropertyKey>& keys)
{
    std::vector<PropertyKey> made;
    for (const PropertyKey& key : keys)
    {
        if (!made.empty() && made.back().time == key.time)
            made.back() = key; // at a jump, the later one is valid
        else if (made.empty() || made.back().value != key.value)
            made.push_back(key);
    }
    if (made.back().time < keys.back().time) made.push_back(keys.back()); // the clip's duration
    return made;
}

std::vector<PropertyKey> withoutHeldKeys(std::vector<PropertyKey> keys)
{
    std::vector<PropertyKey> made;
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (i == 0 || i + 1 == keys.size() || keys[i].value != keys[i - 1].value || keys[i].value != keys[i + 1].value)
            made.push_back(keys[i]);
    return made;
}

/// True if one piece from the first to the last key passes through those between, within the rounding of floats.
bool isOnePiece(const std::vector<PropertyKey>& keys, std::size_t first, std::size_t last)
{
    const PropertyKey &from = keys[first], &to = keys[last];
    const double length = static_cast<double>(to.time) - from.time;
    for (std::size_t number = 0; number < from.value.size(); ++number)
    {
        const double a = from.value[number], b = to.value[number];
        const double out = from.out[number] * length, in = to.in[number] * length;
        const double allowed = 1e-6 * std::max({std::abs(a), std::abs(b), std::abs(out), std::abs(in)});
        for (std::size_t i = first + 1; i < last; ++i)
        {
            const PropertyKey& key = keys[i];
            const double before = static_cast<double>(key.time) - keys[i - 1].time,
                         after = static_cast<double>(keys[i + 1].time) - key.time;
            const double x = (static_cast<double>(key.time) - from.time) / length;
            const double rate = hermiteSlope(a, out, b, in, x) / length;
            if (!(before > 0.0) || !(after > 0.0) ||
                std::abs(hermite(a, out, b, in, x) - key.value[number]) > allowed ||
                std::abs(rate - key.in[number]) * before > allowed ||
                std::abs(rate - key.out[number]) * after > allowed)
                return false;
        }
    }
    return true;
}

std::vector<PropertyKey> joinedPieces(const std::vector<PropertyKey>& keys)
{
    std::vector<PropertyKey> made{keys.front()};
    for (std::size_t first = 0; first + 1 < keys.size();)
    {
        std::size_t last = first + 1;
        while (last + 1 < keys.size() && last - first < maxKeysOfPiece && isOnePiece(keys, first, last + 1))
            ++last;
        made.push_back(keys[last]);
        first = last;
    }
    return made;
}

} // namespace

ClipKeys keysOf(const Clip& clip, const ClipProperty& property, const std::vector<float>& rest)
{
    std::vector<PropertyKey> keys = allKeysOf(clip, property);
    ClipKeys made;
    const auto isAt = [&](const std::vector<float>& value)
    { return std::all_of(keys.begin(), keys.end(), [&](const PropertyKey& key) { return key.value == value; }); };
    const bool held = isHeld(keys);
    if (held && isAt(rest)) return made;
    const bool isConstant = held && isAt(keys.front().value);
    const bool isSpline = isSplineOf(clip, property) && !held;
    if (held && !isConstant)
    {
        made.interpolation = "STEP";
        keys = changesOf(keys);
    }
    else if (isSpline)
    {
        made.interpolation = "CUBICSPLINE";
        keys = joinedPieces(withoutJumps(std::move(keys)));
    }
    else
        keys = withoutHeldKeys(withoutJumps(std::move(keys)));
    for (const PropertyKey& key : keys)
    {
        made.times.push_back(key.time);
        if (isSpline) made.values.insert(made.values.end(), key.in.begin(), key.in.end());
        made.values.insert(made.values.end(), key.value.begin(), key.value.end());
        if (isSpline) made.values.insert(made.values.end(), key.out.begin(), key.out.end());
    }
    return made;
}

} // namespace osgGpuAnimation::gltf
