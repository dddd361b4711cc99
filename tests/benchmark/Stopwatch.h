// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation::benchmark
{

/// Elapsed seconds: CPU time of the whole process on all processors, and wall-clock time.
struct Spent
{
    double cpu = 0.0;
    double wall = 0.0;
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

} // namespace osgGpuAnimation::benchmark
