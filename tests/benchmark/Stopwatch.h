// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation::benchmark
{

/// Seconds spent on something: by the whole process on all processors, and by the clock on the wall.
struct Spent
{
    double cpu = 0.0;
    double wall = 0.0;
};

/// Measures from its making on.
class Stopwatch
{
public:
    Stopwatch();
    Spent elapsed() const;

private:
    Spent _start;
};

} // namespace osgGpuAnimation::benchmark
