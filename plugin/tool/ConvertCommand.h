// SPDX-License-Identifier: MIT
#pragma once

#include "tool/ModelFile.h"

namespace osgGpuAnimation::tool
{

/// `osggpuanim convert`: writes a model with all its clips as a GLB, see gltf::exportModel(), or in OSG's own formats.
struct ConvertCommand : ModelArguments
{
    std::string output; ///< a .glb, .osgb, .osgt or .osgx

    /// Error messages begin with the name of the file at fault.
    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
