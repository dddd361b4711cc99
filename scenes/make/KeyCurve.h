// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace osgGpuAnimation::scenes
{

/// A smooth curve through keys of one cycle, [0, 1), repeated for ever. It never swings past a key: between two
/// equal keys it is flat (monotone cubic interpolation after Fritsch and Carlson).
class KeyCurve
{
public:
    struct Key
    {
        double phase; ///< [0, 1), rising from key to key
        double value;
    };

    explicit KeyCurve(std::vector<Key> keys);

    double at(double phase) const; ///< any phase: the whole part does not count

private:
    std::vector<Key> _keys; ///< with the last key one cycle before, and the first one and two cycles after
    std::vector<double> _slopes;
};

} // namespace osgGpuAnimation::scenes
