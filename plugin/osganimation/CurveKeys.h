// SPDX-License-Identifier: MIT
#pragma once

#include <osgAnimation/Channel>

#include <cmath>
#include <vector>

namespace osgGpuAnimation::osganimation
{

/// A curve's value at one time.
template <class Value>
struct CurveKey
{
    double seconds;
    Value value;
};

/// The key times of all channels, ascending, each once: floats from 0 on, as clips have them. Others are left out.
std::vector<double> keyTimesOf(const std::vector<osg::ref_ptr<osgAnimation::Channel>>& channels);

/// Adds keys between two, until linear values between the keys differ from the curve's by less than 1e-5 of its size.
template <class Curve, class Value>
void addKeysBetween(Curve& curve, const CurveKey<Value>& from, const CurveKey<Value>& to, int depth,
                    std::vector<CurveKey<Value>>& keys)
{
    constexpr int maxHalvings = 8;
    bool isLinear = true;
    for (const double share : {0.25, 0.5, 0.75})
    {
        const Value exact = curve.at(from.seconds + share * (to.seconds - from.seconds));
        const Value linear = Curve::between(from.value, to.value, static_cast<float>(share));
        isLinear = isLinear && Curve::difference(linear, exact) <= 1e-5 * Curve::size(exact);
    }
    const auto middle = static_cast<double>(static_cast<float>(0.5 * (from.seconds + to.seconds)));
    if (isLinear || depth == maxHalvings || !(from.seconds < middle && middle < to.seconds)) return;
    const CurveKey<Value> between{middle, curve.at(middle)};
    addKeysBetween(curve, from, between, depth + 1, keys);
    keys.push_back(between);
    addKeysBetween(curve, between, to, depth + 1, keys);
}

/// Keys for linear interpolation: at the given times, ascending, and at as many more as it takes, see addKeysBetween().
/// Where the curve jumps, two keys are next to each other. Curve: has at(seconds), and between(), difference() and
/// size() of its values.
template <class Curve>
auto linearKeys(Curve& curve, const std::vector<double>& times)
{
    using Value = decltype(curve.at(0.0));
    std::vector<CurveKey<Value>> keys;
    for (const double time : times)
    {
        const CurveKey<Value> next{time, curve.at(time)};
        if (!keys.empty())
        {
            // A step: the value just before this key is far from the value at it.
            const CurveKey<Value> previous = keys.back();
            const double before = static_cast<double>(std::nextafter(static_cast<float>(time), 0.0f));
            const CurveKey<Value> last{before, before > previous.seconds ? curve.at(before) : next.value};
            const bool isStep = Curve::difference(last.value, next.value) > 1e-3 * Curve::size(next.value) + 1e-9;
            addKeysBetween(curve, previous, isStep ? last : next, 0, keys);
            if (isStep) keys.push_back(last);
        }
        keys.push_back(next);
    }
    return keys;
}

} // namespace osgGpuAnimation::osganimation
