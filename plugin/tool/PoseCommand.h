// SPDX-License-Identifier: MIT
#pragma once

#include "tool/ModelFile.h"
#include "tool/PoseDocument.h"

#include <osgGpuAnimation/math/Result.h>

#include <string>

namespace osgGpuAnimation::tool
{

/// `osggpuanim pose`: writes the poses of a file's joints and vertices at given times, see PoseDocument.
struct PoseCommand : ModelArguments
{
    enum class Evaluator
    {
        Gpu,
        Cpu,
    };

    std::string like;    ///< a document that gives the request; empty: use `request`
    PoseRequest request; ///< clip and times; bind with no times is time 0
    Evaluator evaluator = Evaluator::Gpu;
    std::string output; ///< empty: standard output

    /// Error messages begin with the name of the file at fault.
    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
