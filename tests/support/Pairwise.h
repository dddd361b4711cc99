// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// Rows of values, one per parameter, in which each pair of values of two parameters occurs at least once: far fewer
/// rows than the product. counts: the number of values of each parameter; a value is in [0, count).
inline std::vector<std::vector<int>> pairwise(const std::vector<int>& counts)
{
    std::mt19937 random(1);
    using Place = std::pair<std::size_t, int>;
    std::vector<std::pair<Place, Place>> open;
    for (std::size_t first = 0; first < counts.size(); ++first)
        for (std::size_t second = first + 1; second < counts.size(); ++second)
            for (int a = 0; a < counts[first]; ++a)
                for (int b = 0; b < counts[second]; ++b)
                    open.push_back({{first, a}, {second, b}});
    const auto holds = [](const std::vector<int>& row, const auto& pair)
    { return row[pair.first.first] == pair.first.second && row[pair.second.first] == pair.second.second; };
    std::vector<std::vector<int>> rows;
    while (!open.empty())
    {
        std::vector<int> best;
        std::ptrdiff_t mostCovered = 0;
        for (int attempt = 0; attempt < 50; ++attempt)
        {
            std::vector<int> row;
            for (const int count : counts)
                row.push_back(std::uniform_int_distribution<int>(0, count - 1)(random));
            row[open.front().first.first] = open.front().first.second;
            row[open.front().second.first] = open.front().second.second;
            const auto covered =
                std::count_if(open.begin(), open.end(), [&](const auto& pair) { return holds(row, pair); });
            if (covered <= mostCovered) continue;
            mostCovered = covered;
            best = row;
        }
        open.erase(std::remove_if(open.begin(), open.end(), [&](const auto& pair) { return holds(best, pair); }),
                   open.end());
        rows.push_back(best);
    }
    return rows;
}

} // namespace osgGpuAnimation
