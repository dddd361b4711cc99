// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <string>

namespace osgGpuAnimation::tool
{

/// Reads and imports a .gltf or .glb, in the file's own axes if options.noRotation says so.
/// Errors: there is no such file, it is a folder or cannot be read, it is empty, or the import refuses it.
Result<gltf::ImportedModel> readModel(const std::string& fileName, const gltf::ImportOptions& options);

} // namespace osgGpuAnimation::tool
