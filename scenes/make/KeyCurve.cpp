// SPDX-License-Identifier: MIT
#include "KeyCurve.h"

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

double secant(const KeyCurve::Key& from, const KeyCurve::Key& to)
{
    return (to.value - from.value) / (to.phase - from.phase);
}

/// The harmonic mean of the slopes on both sides, zero at a turning point: keeps the curve monotone.
double slopeAt(const KeyCurve::Key& before, const KeyCurve::Key& key, const KeyCurve::Key& after)
{
    const double left = secant(before, key);
    const double right = secant(key, after);
    return left * right <= 0.0 ? 0.0 : 2.0 * left * right / (left + right);
}

} // namespace

KeyCurve::KeyCurve(std::vector<Key> keys)
{
    const std::size_t count = keys.size();
    for (int cycle = -1; cycle <= 1; ++cycle)
        for (const Key& key : keys)
            _keys.push_back({key.phase + cycle, key.value});
    _slopes.assign(_keys.size(), 0.0);
    for (std::size_t key = count - 1; key <= 2 * count; ++key)
        if (key > 0 && key + 1 < _keys.size()) _slopes[key] = slopeAt(_keys[key - 1], _keys[key], _keys[key + 1]);
}

double KeyCurve::at(double phase) const
{
    phase -= std::floor(phase);
    std::size_t next = 1;
    while (next + 1 < _keys.size() && _keys[next].phase <= phase)
        ++next;
    const Key& from = _keys[next - 1];
    const Key& to = _keys[next];
    const double width = to.phase - from.phase;
    const double t = (phase - from.phase) / width;
    const double rise = t * t * (3.0 - 2.0 * t);
    return from.value + (to.value - from.value) * rise + _slopes[next - 1] * width * t * (1.0 - t) * (1.0 - t) -
           _slopes[next] * width * t * t * (1.0 - t);
}

} // namespace osgGpuAnimation::scenes
