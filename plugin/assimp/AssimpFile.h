// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <string>

struct aiScene;

namespace Assimp
{
class Importer;
}

namespace osgGpuAnimation::assimp
{

/// A file of any format that Assimp reads, as GLB; see glbOf(). Files of FBX become metres by their unit; other formats
/// keep their numbers.
///
/// Assimp checks files less than the reader of glTF does: a faulty file may end the process. Plugins and tools call
/// readAsGlbApart() (ConversionProcess.h), which starts another process for it and limits its time. What is bounded
/// here: the file's size (maxFileBytes), other files that it names (in or below its folder, unless
/// options.allowOutsideFiles), and the result (options.maxDecodedBytes).
/// Errors: those bounds; Assimp cannot read the file; see glbOf().
Result<std::string> readAsGlb(const std::string& fileName, const gltf::ImportOptions& options, gltf::Report& report);

/// The scene behind readAsGlb(), owned by the importer, with what Assimp loses of FBX added (see completeFbx()).
Result<const aiScene*> readScene(Assimp::Importer& importer, const std::string& fileName,
                                 const gltf::ImportOptions& options, gltf::Report& report);

/// True for an extension (`fbx`) of Assimp's list.
bool isFormat(const std::string& extension);

constexpr std::size_t maxFileBytes = std::size_t(512) << 20;

} // namespace osgGpuAnimation::assimp
