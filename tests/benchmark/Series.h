// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// Elapsed seconds: CPU time of the whole process on all processors, and wall-clock time.
struct Spent
{
    double cpu = 0.0;
    double wall = 0.0;

    Spent operator+(const Spent& other) const { return {cpu + other.cpu, wall + other.wall}; }
};

/// Measures from its construction on.
class Stopwatch
{
public:
    Stopwatch();
    Spent elapsed() const;

private:
    Spent _start;
};

/// The median of several rounds and its quartiles.
struct Figure
{
    double median = 0.0;
    double low = 0.0;
    double high = 0.0;
};

Figure figureOf(std::vector<double> values);
Figure figureOf(double value); ///< Of a single round.

/// The cost of one contestant per round.
using Series = std::vector<Spent>;

/// The CPU or wall-clock times, multiplied by the scale.
Figure figureOf(const Series& series, double scale = 1.0, double Spent::*clock = &Spent::cpu);
/// The quotient of the CPU times, round by round: slowdowns that affect both contestants cancel out.
Figure ratioOf(const Series& dividend, const Series& divisor);

/// Runs the contestants in turns, once unmeasured and then `rounds` times; returns one series per contestant.
std::vector<Series> interleaved(int rounds, const std::vector<std::function<Spent()>>& contestants);

} // namespace osgGpuAnimation::benchmark
