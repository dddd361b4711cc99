// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace osgGpuAnimation::assimp
{

/// Keys whose interpolation follows a function of time.
///
/// times: where the function bends or jumps, in any order; only those between begin and end count. function(seconds,
/// before): its value, or with before its limit from earlier times. between(a, b, share) interpolates as the player of
/// the keys does; distance(a, b) is compared with the tolerance.
/// Returns keys of times from 0 (begin) to end - begin: at least the two ends, or one if they are the same.
template <class Function, class Between, class Distance>
auto sampledTrack(std::vector<double> times, double begin, double end, const Function& function, const Between& between,
                  const Distance& distance, double tolerance)
{
    using Value = decltype(function(begin, false));
    std::vector<std::pair<double, Value>> keys{{0.0, function(begin, false)}};
    times.push_back(end);
    std::sort(times.begin(), times.end());
    constexpr int maxHalvings = 8;

    struct Span
    {
        double from, to;
        Value first, last;
        int halvings;
    };
    const auto addSpan = [&](double from, double to, const Value& last)
    {
        std::vector<Span> open{{from, to, keys.back().second, last, 0}};
        while (!open.empty())
        {
            const Span span = open.back();
            open.pop_back();
            double deviation = 0.0;
            for (const double share : {0.25, 0.5, 0.75}) // the middle alone would miss curves of the shape of an S
                deviation = std::max(deviation, distance(function(span.from + share * (span.to - span.from), false),
                                                         between(span.first, span.last, share)));
            const double middle = 0.5 * (span.from + span.to);
            if (deviation <= tolerance || span.halvings == maxHalvings)
            {
                keys.emplace_back(span.to - begin, span.last);
                continue;
            }
            const Value value = function(middle, false);
            open.push_back({middle, span.to, value, span.last, span.halvings + 1});
            open.push_back({span.from, middle, span.first, value, span.halvings + 1});
        }
    };
    double from = begin;
    for (const double to : times)
    {
        if (to <= from || to > end) continue;
        const Value before = function(to, true), value = to < end ? function(to, false) : before;
        addSpan(from, to, before);
        const double ending = std::nextafter(static_cast<float>(to - begin), 0.0f);
        if (distance(before, value) > tolerance && ending > keys[keys.size() - 2].first)
        {
            keys.back().first = ending;
            keys.emplace_back(to - begin, value);
        }
        else
            keys.back().second = value;
        from = to;
    }
    return keys;
}

/// sampledTrack() with a tolerance relative to the largest magnitude at the begin and those times.
template <class Function, class Between, class Distance, class Magnitude>
auto relativeTrack(std::vector<double> times, double begin, double end, const Function& function,
                   const Between& between, const Distance& distance, const Magnitude& magnitude,
                   double relativeTolerance)
{
    std::sort(times.begin(), times.end()); // curves of one track share many
    times.erase(std::unique(times.begin(), times.end()), times.end());
    double size = magnitude(function(begin, false));
    for (const double time : times)
        size = std::max(size, static_cast<double>(magnitude(function(time, false))));
    return sampledTrack(std::move(times), begin, end, function, between, distance, relativeTolerance * size);
}

} // namespace osgGpuAnimation::assimp
