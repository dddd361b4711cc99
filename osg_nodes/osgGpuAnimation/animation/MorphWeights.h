// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The morph weights of one mesh instance: one node of the file with a mesh that has morph targets. The GPU treats them
/// like joints: twelve weights form a **weight block**, which takes the 48 bytes of a joint transform in a keyframe and
/// the 48 bytes of a palette entry in the output.
struct MorphWeights
{
    static constexpr std::size_t weightsPerBlock = 12;

    std::string name;
    int sourceNode = -1;         ///< number of the node in the file
    std::vector<float> defaults; ///< one per target: the weights of the node, else of the mesh, else 0

    std::size_t blockCount() const { return (defaults.size() + weightsPerBlock - 1) / weightsPerBlock; }
};

} // namespace osgGpuAnimation
