// SPDX-License-Identifier: MIT
#include "Stopwatch.h"

#include <ctime>

namespace osgGpuAnimation::benchmark
{

namespace
{

double now(clockid_t clock)
{
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Spent nowOnAll()
{
    return {now(CLOCK_PROCESS_CPUTIME_ID), now(CLOCK_MONOTONIC)};
}

} // namespace

Stopwatch::Stopwatch() : _start(nowOnAll()) {}

Spent Stopwatch::elapsed() const
{
    const Spent end = nowOnAll();
    return {end.cpu - _start.cpu, end.wall - _start.wall};
}

} // namespace osgGpuAnimation::benchmark
