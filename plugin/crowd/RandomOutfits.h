// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/OutfitsFile.h>

#include <cstdint>
#include <random>
#include <vector>

namespace osgGpuAnimation::crowd
{

constexpr std::size_t randomOutfitCount = 24;

/// Random in [0, 1), the same with every standard library (std::uniform_real_distribution is not).
inline double randomShare(std::mt19937& random)
{
    return static_cast<double>(random()) / 4294967296.0;
}

/// Outfits for the option `outfits=random`. Rigid parts on one joint exclude each other: an outfit shows one of them or
/// none. If the crowd has several materials, each gets a pale colour of a random hue, but those whose names speak of
/// skin, faces, eyes or hair.
std::vector<OutfitShare> randomOutfits(const AnimatedCrowd& crowd, std::uint32_t seed);

} // namespace osgGpuAnimation::crowd
