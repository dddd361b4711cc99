// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The masks of one AnimationSet. Masks are never removed or changed, so the weights of a mask stay valid while other
/// threads add masks. Safe to use from several threads.
class MaskTable
{
public:
    static constexpr std::size_t maxMasks = 1024;

    MaskTable() = default;
    MaskTable(const MaskTable& other);
    MaskTable& operator=(const MaskTable&) = delete;

    /// The number of the mask with these weights, from 1 on. Adds it if it is new. 0: the table is full.
    std::uint32_t add(const std::vector<float>& weights);

    std::size_t count() const;
    /// The weights of a mask, one per track; null for 0 (no mask) and for unknown numbers.
    const float* weights(std::uint32_t number) const;

private:
    mutable std::mutex _mutex;
    std::deque<std::vector<float>> _masks;
};

} // namespace osgGpuAnimation
