// SPDX-License-Identifier: MIT
#pragma once

#include "tool/PoseRequest.h"

#include <osgGpuAnimation/math/Result.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::tool
{

/// `osggpuanim pose`: writes the poses of a file's joints and vertices at given times, see PoseDocument.
struct PoseCommand
{
    enum class Evaluator
    {
        Gpu,
        Cpu,
    };

    std::string file;
    std::vector<std::string> clips; ///< files whose clips are added
    std::string clipJoints;         ///< a JSON file of joint names for those files; empty: none
    std::string like;               ///< a document that gives the request; empty: use `request`
    PoseRequest request;            ///< clip and times; bind with no times is time 0
    Evaluator evaluator = Evaluator::Gpu;
    std::string output; ///< empty: standard output

    /// Error messages begin with the name of the file at fault.
    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
