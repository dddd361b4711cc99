// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

namespace osgGpuAnimation::scenes
{

struct JointWeight
{
    int joint = 0;
    double weight = 0.0; ///< [0, 1]
};

/// What moves a vertex: joints with weights that sum to one.
class Binding
{
public:
    Binding() = default;
    explicit Binding(int joint) : _weights{{joint, 1.0}} {}

    /// Gives `share` of this binding to another one: share 0 leaves all as it is, share 1 replaces it.
    Binding& give(double share, const Binding& other);
    Binding& give(double share, int joint) { return give(share, Binding(joint)); }

    const std::vector<JointWeight>& weights() const { return _weights; }
    /// The joints renamed: joint j becomes renamed(j).
    template <typename Function>
    Binding renamed(Function&& rename) const
    {
        Binding result = *this;
        for (JointWeight& entry : result._weights)
            entry.joint = rename(entry.joint);
        return result;
    }

    /// The four strongest as multiples of 1/256 that sum to one exactly; joint 0 where a place is empty.
    std::array<JointWeight, 4> quantised() const;

private:
    std::vector<JointWeight> _weights;
};

} // namespace osgGpuAnimation::scenes
