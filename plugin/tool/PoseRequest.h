// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::tool
{

/// Which poses of a file are wanted. Numbers of nodes, primitives and animations are the file's own.
struct PoseRequest
{
    /// Morph weights set by hand: they take the place of the clip's and the file's.
    struct FixedWeights
    {
        int node = -1;
        std::vector<double> weights;
    };
    using PrimitiveKey = std::pair<int, int>; ///< node, and primitive within its mesh

    std::optional<int> animation; ///< the clip, by the file's number
    std::optional<std::string>
        clip;                  ///< the clip by its name, or by number where none has that name; default: the first
    bool bind = false;         ///< no clip: the nodes as the file has them
    std::vector<double> times; ///< seconds on the clip's own time line
    std::vector<FixedWeights> fixedWeights;
    /// The vertices whose positions are wanted. Where a primitive is not listed: all up to 64, else 64 spread evenly.
    std::map<PrimitiveKey, std::vector<std::uint32_t>> sampled;
};

/// The request that a document of schema gltf-pose/1 is the answer to: its clip, times, set weights and vertices.
/// Errors name the member: not readable, not JSON, another schema, a member missing or of another type.
Result<PoseRequest> readPoseRequest(const std::string& fileName);

} // namespace osgGpuAnimation::tool
