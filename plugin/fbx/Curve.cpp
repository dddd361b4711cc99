// SPDX-License-Identifier: MIT
#include "fbx/Curve.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgGpuAnimation::fbx
{

namespace
{

// Bits of KeyAttrFlags, and the four numbers that KeyAttrDataFloat has for each of them.
constexpr unsigned int stepped = 0x2, cubicKey = 0x8, steppedNext = 0x100, automatic = 0x100, userTangent = 0x400,
                       weightedRight = 0x1000000, weightedNextLeft = 0x2000000;
constexpr std::size_t numbersOfKey = 4, rightSlope = 0, nextLeftSlope = 1, weights = 2;

/// Two weights of 16 bits, in 1/9999.
std::array<double, 2> unpackedWeights(double number, bool isBits)
{
    std::uint32_t bits = 0;
    if (isBits)
        bits = number >= -2147483648.0 && number <= 4294967295.0
                   ? static_cast<std::uint32_t>(static_cast<std::int64_t>(number))
                   : 0;
    else
    {
        const auto value = static_cast<float>(number);
        std::memcpy(&bits, &value, sizeof(bits));
    }
    constexpr double unit = 9999.0;
    return {(bits & 0xffffu) / unit, (bits >> 16) / unit};
}

double bezier(double a, double b, double c, double d, double t)
{
    const double s = 1.0 - t;
    return s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d;
}

} // namespace

Curve Curve::of(const Element& element, double ticksPerSecond)
{
    Curve curve;
    const std::vector<double> times = element.numbers("KeyTime"), values = element.numbers("KeyValueFloat");
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < std::min(times.size(), values.size()); ++i)
    {
        const double time = times[i] / ticksPerSecond;
        // An ASCII file may print the bits of values, too: of tangents alone is it known to.
        if (!std::isfinite(time) || !std::isfinite(values[i]) ||
            (!curve._keys.empty() && time <= curve._keys.back().time))
            continue;
        curve._keys.push_back({time, values[i]});
        kept.push_back(i);
    }
    if (kept.size() == std::min(times.size(), values.size())) curve.readTangents(element);
    return curve;
}

void Curve::readTangents(const Element& element)
{
    const std::vector<double> flags = element.numbers("KeyAttrFlags"), counts = element.numbers("KeyAttrRefCount"),
                              data = element.numbers("KeyAttrDataFloat");
    const Element* const dataElement = element.child("KeyAttrDataFloat");
    const bool isText = dataElement && dataElement->arrayType == 0;
    std::size_t key = 0;
    for (std::size_t i = 0; i < flags.size(); ++i)
    {
        const double given = i < counts.size() ? counts[i] : 1.0;
        const auto bits = flags[i] >= 0.0 && flags[i] <= 4294967295.0 ? static_cast<unsigned int>(flags[i]) : 0u;
        for (double n = 0.0; n < given && key < _keys.size(); n += 1.0, ++key)
        {
            Key& made = _keys[key];
            if (bits & stepped)
                made.interpolation = bits & steppedNext ? Interpolation::SteppedNext : Interpolation::Stepped;
            if (!(bits & cubicKey)) continue;
            made.interpolation = Interpolation::Cubic;
            const bool isAutomatic = (bits & automatic) && !(bits & userTangent);
            const bool hasData = data.size() >= numbersOfKey * (i + 1);
            const auto number = [&](std::size_t which)
            {
                const double value = hasData ? data[numbersOfKey * i + which] : 0.0;
                const double read = isText ? floatOfBits(value) : value;
                return std::isfinite(read) ? read : 0.0;
            };
            made.slope = isAutomatic ? automaticSlope(key) : number(rightSlope);
            made.nextSlope = isAutomatic ? automaticSlope(key + 1) : number(nextLeftSlope);
            if (!hasData) continue;
            const std::array<double, 2> both = unpackedWeights(data[numbersOfKey * i + weights], isText);
            if (bits & weightedRight) made.weight = std::clamp(both[0], 1e-4, 1.0);
            if (bits & weightedNextLeft) made.nextWeight = std::clamp(both[1], 1e-4, 1.0);
        }
    }
}

/// Level at ends and at extremes, otherwise towards the neighbours, and so that no tangent overshoots.
double Curve::automaticSlope(std::size_t key) const
{
    if (key == 0 || key + 1 >= _keys.size()) return 0.0;
    const Key &before = _keys[key - 1], &at = _keys[key], &after = _keys[key + 1];
    const double left = (at.value - before.value) / (at.time - before.time);
    const double right = (after.value - at.value) / (after.time - at.time);
    if (left * right <= 0.0) return 0.0;
    const double slope = (after.value - before.value) / (after.time - before.time);
    const double limit = 3.0 * std::min(std::abs(left), std::abs(right));
    return std::clamp(slope, -limit, limit);
}

double Curve::cubic(const Key& key, const Key& next, double seconds)
{
    const double interval = next.time - key.time;
    const double share = (seconds - key.time) / interval;
    // The tangents' ends are at weight and 1 - nextWeight of the interval: find the parameter of this time.
    double low = 0.0, high = 1.0, t = share;
    constexpr int halvings = 48;
    const bool isUniform = std::abs(key.weight - 1.0 / 3.0) < 1e-3 && std::abs(key.nextWeight - 1.0 / 3.0) < 1e-3;
    for (int i = 0; i < halvings && !isUniform; ++i)
    {
        (bezier(0.0, key.weight, 1.0 - key.nextWeight, 1.0, t) < share ? low : high) = t;
        t = 0.5 * (low + high);
    }
    const double right = isUniform ? 1.0 / 3.0 : key.weight, left = isUniform ? 1.0 / 3.0 : key.nextWeight;
    return bezier(key.value, key.value + key.slope * right * interval, next.value - key.nextSlope * left * interval,
                  next.value, t);
}

double Curve::at(double seconds, bool before) const
{
    if (_keys.empty()) return 0.0;
    const auto after = before ? std::lower_bound(_keys.begin(), _keys.end(), seconds,
                                                 [](const Key& key, double time) { return key.time < time; })
                              : std::upper_bound(_keys.begin(), _keys.end(), seconds,
                                                 [](double time, const Key& key) { return time < key.time; });
    if (after == _keys.begin()) return after->value;
    const Key& key = *(after - 1);
    if (after == _keys.end()) return key.value;
    switch (key.interpolation)
    {
    case Interpolation::Stepped:
        return key.value;
    case Interpolation::SteppedNext:
        return after->value;
    case Interpolation::Cubic:
        return cubic(key, *after, seconds);
    case Interpolation::Linear:
        break;
    }
    return key.value + (after->value - key.value) * (seconds - key.time) / (after->time - key.time);
}

void Curve::appendTimes(std::vector<double>& times) const
{
    for (const Key& key : _keys)
        times.push_back(key.time);
}

glm::dvec3 AnimatedVector::at(double seconds, bool before) const
{
    glm::dvec3 value = rest;
    for (const Layer& layer : layers)
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto place = static_cast<std::size_t>(axis);
            const std::optional<Curve>& curve = layer.curves[place];
            if (!curve && !layer.constants[place]) continue;
            const double animated = curve ? curve->at(seconds, before) : *layer.constants[place];
            double& component = value[axis];
            if (layer.isOverride)
                component += layer.weight * (animated - component);
            else if (isFactor)
                component *= 1.0 + layer.weight * (animated - 1.0);
            else
                component += layer.weight * animated;
        }
    return value;
}

void AnimatedVector::appendTimes(std::vector<double>& times) const
{
    for (const Layer& layer : layers)
        for (const std::optional<Curve>& curve : layer.curves)
            if (curve) curve->appendTimes(times);
}

} // namespace osgGpuAnimation::fbx
