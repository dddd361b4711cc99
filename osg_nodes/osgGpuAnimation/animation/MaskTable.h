// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The masks of one AnimationSet. It only grows: a mask that is in stays, unchanged and at its place, so that what one
/// thread adds another may read later. Safe to use from several threads.
class MaskTable
{
public:
    static constexpr std::size_t maxMasks = 1024;

    MaskTable() = default;
    MaskTable(const MaskTable& other);
    MaskTable& operator=(const MaskTable&) = delete;

    /// The number of the mask with these weights, from 1 on; it is added if there is none yet. 0: the table is full.
    std::uint32_t add(const std::vector<float>& weights);

    std::size_t count() const;
    /// The weights of a mask, one a track; null for 0 (no mask) and for numbers that were never given.
    const float* weights(std::uint32_t number) const;

private:
    mutable std::mutex _mutex;
    std::deque<std::vector<float>> _masks;
};

} // namespace osgGpuAnimation
