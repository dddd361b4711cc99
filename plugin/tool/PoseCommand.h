// SPDX-License-Identifier: MIT
#pragma once

#include "tool/ModelFile.h"

#include <osgGpuAnimation/math/Result.h>

#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation::tool
{

/// `osggpuanim pose`: writes the poses of a file's joints and vertices at given times in the schema gltf-pose/1: JSON,
/// in the file's own axes, units and numbers; matrices are 16 numbers, column-major for column vectors. A pose holds
/// the world matrix of every node that is a joint (null for others), the joint matrices by skin, the morph weights, and
/// of each primitive its bounding box and the requested vertices. `modelSize` is the diagonal of the first pose's box;
/// comparisons divide lengths by it (errors of compact clips refer to the longest side at rest instead).
struct PoseCommand : ModelArguments
{
    std::string like;                ///< a document whose clip, times, set weights and vertices are taken; empty: none
    std::optional<std::string> clip; ///< by its name, or by number where none has that name; default: the first
    bool bind = false;               ///< no clip: the nodes at rest, at time 0
    std::vector<double> times;       ///< seconds from the beginning of the clip
    bool onGpu = true;               ///< false: the CPU computes the poses
    std::string output;              ///< empty: standard output

    /// Error messages begin with the name of the file at fault.
    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
