// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::tool
{

/// The poses to compute of a file. Numbers of nodes, primitives and animations are those of the file.
struct PoseRequest
{
    /// Morph weights that override the weights of the clip and of the file.
    struct FixedWeights
    {
        int node = -1;
        std::vector<double> weights;
    };
    using PrimitiveKey = std::pair<int, int>; ///< node, and primitive within its mesh

    std::optional<int> animation; ///< the clip, by the file's number
    std::optional<std::string>
        clip;                  ///< the clip by its name, or by number where none has that name; default: the first
    bool bind = false;         ///< no clip: the nodes at rest
    std::vector<double> times; ///< seconds from the beginning of the clip
    std::vector<FixedWeights> fixedWeights;
    /// The vertices whose positions are computed. For a primitive that is not listed: all if there are at most 64, else
    /// 64 spread evenly.
    std::map<PrimitiveKey, std::vector<std::uint32_t>> sampled;
};

/// The request that a document of schema gltf-pose/1 answers: its clip, times, set weights and vertices.
/// Errors name the member: not readable, not JSON, another schema, a missing member or one of another type.
Result<PoseRequest> readPoseRequest(const std::string& fileName);

} // namespace osgGpuAnimation::tool
