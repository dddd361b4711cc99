// SPDX-License-Identifier: MIT
#include "Series.h"

#include <algorithm>
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

} // namespace

Stopwatch::Stopwatch() : _start{now(CLOCK_PROCESS_CPUTIME_ID), now(CLOCK_MONOTONIC)} {}

Spent Stopwatch::elapsed() const
{
    return {now(CLOCK_PROCESS_CPUTIME_ID) - _start.cpu, now(CLOCK_MONOTONIC) - _start.wall};
}

Figure figureOf(std::vector<double> values)
{
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t last = values.size() - 1;
    const double median = 0.5 * (values[last / 2] + values[values.size() / 2]);
    return {median, values[last / 4], values[last - last / 4]};
}

Figure figureOf(double value)
{
    return {value, value, value};
}

Figure figureOf(const Series& series, double scale, double Spent::*clock)
{
    std::vector<double> values;
    for (const Spent& spent : series)
        values.push_back(scale * (spent.*clock));
    return figureOf(std::move(values));
}

Figure ratioOf(const Series& dividend, const Series& divisor)
{
    std::vector<double> values;
    for (std::size_t round = 0; round < std::min(dividend.size(), divisor.size()); ++round)
        if (divisor[round].cpu > 0.0) values.push_back(dividend[round].cpu / divisor[round].cpu);
    return figureOf(std::move(values));
}

std::vector<Series> interleaved(int rounds, const std::vector<std::function<Spent()>>& contestants)
{
    std::vector<Series> series(contestants.size());
    for (int round = -1; round < rounds; ++round)
        for (std::size_t i = 0; i < contestants.size(); ++i)
        {
            const Spent spent = contestants[i]();
            if (round >= 0) series[i].push_back(spent);
        }
    return series;
}

} // namespace osgGpuAnimation::benchmark
