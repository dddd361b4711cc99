// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The morph weights of one mesh instance (one node of the file with a morphing mesh). They travel through the same
/// pipeline as the joints: packed twelve to a **weight block**, which takes the 48 bytes of a joint transform in a
/// keyframe and the 48 bytes of a palette entry on the way out.
struct MorphWeights
{
    static constexpr std::size_t weightsPerBlock = 12;

    std::string name;
    int sourceNode = -1;         ///< the file's own node number
    std::vector<float> defaults; ///< one a target: the node's weights, else the mesh's, else 0

    std::size_t blockCount() const { return (defaults.size() + weightsPerBlock - 1) / weightsPerBlock; }
};

} // namespace osgGpuAnimation
