// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// Adds keys between two, halving at most `halvings` times, until interpolation deviates from the function by at most
/// one tolerance. See sampledTrack().
template <class Value, class Function, class Between, class Deviation>
void addKeysBetween(const std::pair<double, Value>& from, const std::pair<double, Value>& to, int halvings,
                    const Function& function, const Between& between, const Deviation& deviation,
                    std::vector<std::pair<double, Value>>& keys)
{
    bool deviates = false;                       // what is no number does not
    for (const double share : {0.25, 0.5, 0.75}) // the middle alone would miss curves of the shape of an S
        deviates = deviates || deviation(between(from.second, to.second, share),
                                         function(from.first + share * (to.first - from.first), false)) > 1.0;
    const auto middle = static_cast<double>(static_cast<float>(0.5 * (from.first + to.first)));
    if (!deviates || halvings == 0 || !(from.first < middle && middle < to.first)) return;
    const std::pair<double, Value> key{middle, function(middle, false)};
    addKeysBetween(from, key, halvings - 1, function, between, deviation, keys);
    keys.push_back(key);
    addKeysBetween(key, to, halvings - 1, function, between, deviation, keys);
}

/// Keys, times and values, whose interpolation follows a function of time: at the given times, ascending, and at as
/// many more as it takes. Where the function jumps, two keys are one float apart.
///
/// function(time, before): its value, or with before its limit from earlier times. between(a, b, share) interpolates as
/// the player of the keys does; deviation(approximate, exact) is in tolerances; minJump: the deviation that is a jump.
template <class Function, class Between, class Deviation>
auto sampledTrack(const std::vector<double>& times, const Function& function, const Between& between,
                  const Deviation& deviation, double minJump)
{
    constexpr int maxHalvings = 8;
    std::vector<std::pair<double, decltype(function(0.0, false))>> keys;
    for (const double time : times)
    {
        auto key = std::make_pair(time, function(time, false));
        if (!keys.empty())
        {
            const auto from = keys.back();
            const auto last = std::make_pair(
                static_cast<double>(std::nextafter(static_cast<float>(time), static_cast<float>(from.first))),
                function(time, true));
            const bool isJump = last.first > from.first && deviation(last.second, key.second) > minJump;
            addKeysBetween(from, isJump ? last : key, maxHalvings, function, between, deviation, keys);
            if (isJump) keys.push_back(last);
        }
        keys.push_back(std::move(key));
    }
    return keys;
}

// For tracks of several numbers.

template <class Number>
std::vector<Number> mixedNumbers(std::vector<Number> from, const std::vector<Number>& to, double share)
{
    for (std::size_t i = 0; i < from.size(); ++i)
        from[i] += static_cast<Number>(share) * (to[i] - from[i]);
    return from;
}

template <class Number>
double largestDifference(const std::vector<Number>& a, const std::vector<Number>& b)
{
    double max = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        max = std::max(max, static_cast<double>(std::abs(a[i] - b[i])));
    return max;
}

} // namespace osgGpuAnimation
