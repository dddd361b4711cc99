// SPDX-License-Identifier: MIT
#pragma once

#include "Stopwatch.h"

#include <functional>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// The median of several rounds, and the quartiles around it.
struct Figure
{
    double median = 0.0;
    double low = 0.0;
    double high = 0.0;
};

Figure figureOf(std::vector<double> values);

/// What one contestant took, round by round.
using Series = std::vector<Spent>;

Figure cpuOf(const Series& series);
Figure wallOf(const Series& series);
/// Each round of one by the same round of the other: what slows both down at a time cancels out.
Figure cpuRatio(const Series& dividend, const Series& divisor);
Figure wallRatio(const Series& dividend, const Series& divisor);

/// Runs the contestants by turns, once unmeasured and then so many rounds; one series a contestant.
std::vector<Series> interleaved(int rounds, const std::vector<std::function<Spent()>>& contestants);

} // namespace osgGpuAnimation::benchmark
