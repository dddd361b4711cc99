// SPDX-License-Identifier: MIT
#include "Binding.h"

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

Binding& Binding::give(double share, const Binding& other)
{
    for (JointWeight& entry : _weights)
        entry.weight *= 1.0 - share;
    for (const JointWeight& added : other._weights)
    {
        auto same = std::find_if(_weights.begin(), _weights.end(),
                                 [&](const JointWeight& entry) { return entry.joint == added.joint; });
        if (same != _weights.end())
            same->weight += added.weight * share;
        else
            _weights.push_back({added.joint, added.weight * share});
    }
    return *this;
}

std::array<JointWeight, 4> Binding::quantised() const
{
    std::vector<JointWeight> sorted = _weights;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const JointWeight& a, const JointWeight& b) { return a.weight > b.weight; });
    sorted.resize(4);
    double sum = 0.0;
    for (const JointWeight& entry : sorted)
        sum += entry.weight;

    std::array<JointWeight, 4> result;
    double rest = 1.0;
    for (std::size_t place = 1; place < 4; ++place)
    {
        const double weight = std::round(sorted[place].weight / sum * 256.0) / 256.0;
        if (weight > 0.0) result[place] = {sorted[place].joint, weight};
        rest -= weight;
    }
    result[0] = {sorted[0].joint, rest};
    return result;
}

} // namespace osgGpuAnimation::scenes
