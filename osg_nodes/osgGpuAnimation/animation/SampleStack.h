// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/PoseInstruction.h>

#include <array>
#include <cstddef>

namespace osgGpuAnimation
{

/// Puts the samples of all layers into the order that PoseInstruction asks for: standings from the bottom up, in each
/// the heaviest sample first (equal weights by keyframe), so that the order in which they come plays no part; additive
/// samples last. Where there are more than an instruction holds, those with the smallest weights give way.
class SampleStack
{
public:
    /// Samples of weight 0 are left out.
    void add(const BlendSample& sample, int standing);
    void addDifference(const BlendSample& reference, const BlendSample& sample);
    /// The rest pose where nothing was added.
    void write(PoseInstruction& out) const;

private:
    struct Placed
    {
        BlendSample sample;
        int standing = 0;
    };
    struct Difference
    {
        BlendSample reference, sample;
    };
    static constexpr std::size_t maxDifferences = PoseInstruction::maxSamples / 2;

    static bool comesBefore(const Placed& a, const Placed& b);
    void removeLightest();

    std::array<Placed, PoseInstruction::maxSamples + 1> _placed;
    std::size_t _placedCount = 0;
    std::array<Difference, maxDifferences> _differences;
    std::size_t _differenceCount = 0;
};

} // namespace osgGpuAnimation
