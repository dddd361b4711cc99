// SPDX-License-Identifier: MIT
#pragma once

#include "Stopwatch.h"

#include <functional>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// The median of several rounds and its quartiles.
struct Figure
{
    double median = 0.0;
    double low = 0.0;
    double high = 0.0;
};

Figure figureOf(std::vector<double> values);

/// The cost of one contestant per round.
using Series = std::vector<Spent>;

Figure cpuOf(const Series& series);
Figure wallOf(const Series& series);
/// The quotient of the two series, round by round: slowdowns that affect both contestants cancel out.
Figure cpuRatio(const Series& dividend, const Series& divisor);
Figure wallRatio(const Series& dividend, const Series& divisor);

/// Runs the contestants in turns, once unmeasured and then `rounds` times; returns one series per contestant.
std::vector<Series> interleaved(int rounds, const std::vector<std::function<Spent()>>& contestants);

} // namespace osgGpuAnimation::benchmark
