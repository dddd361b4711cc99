// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::tool
{

/// `osggpuanim convert`: writes a model with all its clips as a GLB, see gltf::exportModel(), or in OSG's own formats.
struct ConvertCommand
{
    std::string file;               ///< of the tool's own formats, or of OSG's: `nathan.osg.gpuanim`
    std::vector<std::string> clips; ///< files whose clips are added
    std::string clipJoints;         ///< a JSON file of joint names for them; empty: none
    double compact = 0.0;           ///< see gltf::ImportOptions; 0: exact
    std::string output;             ///< a .glb, .osgb, .osgt or .osgx

    /// Error messages begin with the name of the file at fault.
    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
