// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// The number of rounds and characters of a run.
struct Effort
{
    int rounds = 7;                 ///< of fast measurements
    int loadRounds = 21;            ///< of loading a file
    int frameRounds = 3;            ///< of whole frames
    std::size_t barCount = 1000;    ///< characters, for the bars
    std::size_t frameCount = 1000;  ///< characters, for the bars of whole frames
    std::size_t crowdCount = 10000; ///< instances, for the crowd's bar
    std::vector<std::size_t> poseCounts{1, 10, 100, 1000, 10000};
    std::vector<std::size_t> frameCounts{1, 10, 100, 1000};
    std::size_t largestReference = 1000; ///< the most characters for osgAnimation

    static Effort quick() { return {5, 11, 3, 1000, 100, 10000, {10, 100, 1000, 10000}, {10, 100}, 1000}; }
};

} // namespace osgGpuAnimation::benchmark
