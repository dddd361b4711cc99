// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

/// The weights of a mask, see JointMask. It exists as long as somebody holds it: the layers with this mask, and frames
/// until they are drawn.
struct SetMask
{
    std::uint32_t number;       ///< from 1 on, see BlendSample::control; unique among the masks that exist
    std::vector<float> weights; ///< one per track, in [0, 1]
};

/// The masks of one AnimationSet by number. Safe to use from several threads.
class MaskTable
{
public:
    static constexpr std::size_t maxMasks = 4096; ///< the maximum number of masks that exist at one time

    /// The mask with these weights. Creates it if it is new. Null: maxMasks masks exist.
    std::shared_ptr<const SetMask> use(const std::vector<float>& weights);
    /// Null for 0 (no mask) and for numbers without a mask.
    std::shared_ptr<const SetMask> find(std::uint32_t number) const;

private:
    mutable std::mutex _mutex;
    std::vector<std::weak_ptr<const SetMask>> _masks; ///< by number - 1; expired: the number is free
};

} // namespace osgGpuAnimation
