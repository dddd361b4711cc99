// SPDX-License-Identifier: MIT
#include "Series.h"

#include <algorithm>

namespace osgGpuAnimation::benchmark
{

namespace
{

Figure ratio(const Series& dividend, const Series& divisor, double Spent::*clock)
{
    std::vector<double> values;
    for (std::size_t round = 0; round < std::min(dividend.size(), divisor.size()); ++round)
        if (divisor[round].*clock > 0.0) values.push_back(dividend[round].*clock / (divisor[round].*clock));
    return figureOf(std::move(values));
}

Figure figure(const Series& series, double Spent::*clock)
{
    std::vector<double> values;
    for (const Spent& spent : series)
        values.push_back(spent.*clock);
    return figureOf(std::move(values));
}

} // namespace

Figure figureOf(std::vector<double> values)
{
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t last = values.size() - 1;
    const double median = 0.5 * (values[last / 2] + values[values.size() / 2]);
    return {median, values[last / 4], values[last - last / 4]};
}

Figure cpuOf(const Series& series)
{
    return figure(series, &Spent::cpu);
}

Figure wallOf(const Series& series)
{
    return figure(series, &Spent::wall);
}

Figure cpuRatio(const Series& dividend, const Series& divisor)
{
    return ratio(dividend, divisor, &Spent::cpu);
}

Figure wallRatio(const Series& dividend, const Series& divisor)
{
    return ratio(dividend, divisor, &Spent::wall);
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
