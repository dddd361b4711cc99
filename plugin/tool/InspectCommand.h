// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::tool
{

/// `osggpuanim inspect`: prints the content of a file and its memory on standard output.
struct InspectCommand
{
    std::string file;
    std::vector<std::string> clips; ///< files whose clips are added
    std::string clipJoints;         ///< a JSON file of joint names for those files; empty: none
    double compact = 0.0;           ///< see gltf::ImportOptions; 0: exact
    bool json = false;              ///< prints JSON instead of text

    /// Error messages begin with the name of the file at fault.
    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
