// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/PoseInstruction.h>

#include <array>
#include <cstddef>

namespace osgGpuAnimation
{

/// Puts the samples of all layers into the order that PoseInstruction asks for: standings from the bottom up, in each
/// the heaviest sample first (equal weights by keyframe), so that the order in which they come plays no part; additive
/// samples last.
///
/// Where there are more than an instruction holds, the lightest of all gives way, again and again; a difference, which
/// takes two places, as well as a sample. The heaviest of each standing always stays. What gives way in a standing
/// leaves its weight to the others there, so nothing from below, such as the rest pose, comes through.
class SampleStack
{
public:
    static constexpr std::size_t maxItems = 64; ///< samples and differences that all layers may come to

    /// Samples of weight 0 are left out. At most maxItems may be added in all.
    void add(const BlendSample& sample, int standing);
    void addDifference(const BlendSample& reference, const BlendSample& sample);
    /// The rest pose where nothing was added. To be called once.
    void write(PoseInstruction& out);

private:
    struct Item
    {
        BlendSample sample, reference; ///< the reference of a difference
        int standing;                  ///< of a sample
        bool isDifference;
    };
    /// Memory that is not set before it is used: to clear it all would take longer than the rest of it.
    union Place
    {
        Place() {}
        Item item;
    };

    static bool comesBefore(const Item& a, const Item& b);
    void insert(const Item& item);
    bool isAbove(std::size_t index) const;
    void removeLightest();
    void fillStanding(int standing, float removed);

    std::array<Place, maxItems> _places;
    std::size_t _count = 0;
    std::size_t _sampleCount = 0; ///< places that the items take in an instruction
};

} // namespace osgGpuAnimation
