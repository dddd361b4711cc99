// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <string>

namespace osgGpuAnimation::tool
{

/// Reads and imports a .gltf or .glb, or a file of a format that Assimp reads where the build has it, in the file's own
/// axes if options.noRotation says so. Errors: the file does not exist, is a folder, is empty, cannot be read, or the
/// import refuses it.
Result<gltf::ImportedModel> readModel(const std::string& fileName, const gltf::ImportOptions& options);

} // namespace osgGpuAnimation::tool
