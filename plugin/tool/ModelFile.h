// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <string>
#include <vector>

namespace osgGpuAnimation::tool
{

/// The options of an import that adds the clips of these files. clipJoints: a file, see gltf::readClipJoints(); empty:
/// none. The user named them: they may be anywhere, relative to the current folder. Error: a file does not exist; the
/// message begins with its name.
Result<gltf::ImportOptions> importOptions(const std::vector<std::string>& clipsFiles, const std::string& clipJoints);

/// Prints the warnings about clips of other files on standard error.
void printClipWarnings(const gltf::ImportedModel& model);

/// True for names of files that readModel() reads, by their extension.
bool isModelFormat(const std::string& fileName);

/// Reads and imports a .gltf or .glb, or a file of a format that Assimp reads where the build has it, in the file's own
/// axes if options.noRotation says so. Errors: the file does not exist, is a folder, is empty, cannot be read, or the
/// import refuses it.
Result<gltf::ImportedModel> readModel(const std::string& fileName, const gltf::ImportOptions& options);

} // namespace osgGpuAnimation::tool
