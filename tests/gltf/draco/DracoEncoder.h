// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

enum class DracoMethod
{
    Sequential,
    Edgebreaker
};

/// The Draco stream of a mesh, without quantization. Attribute 0: positions, three floats per vertex; attribute 1:
/// joints, four bytes per vertex. Empty if Draco fails.
std::string encodeDraco(const std::vector<float>& positions, const std::vector<std::uint8_t>& joints,
                        const std::vector<std::uint32_t>& indices, DracoMethod method);

} // namespace osgGpuAnimation
