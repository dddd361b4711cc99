// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"
#include "gltf/Import.h"

#include <string>
#include <vector>

namespace osgGpuAnimation::tool
{

/// What all commands are told about a model.
struct ModelArguments
{
    std::string file;               ///< of the tool's own formats, or of OSG's: `nathan.osg.gpuanim`
    std::vector<std::string> clips; ///< files whose clips are added
    std::string clipJoints;         ///< a JSON file of joint names for them, see gltf::readClipJoints(); empty: none
    ClipMatch clipMatch = ClipMatch::Automatic; ///< of those clips
    double compact = 0.0;                       ///< see gltf::ImportOptions; 0: exact
};

/// The options of an import. The user named the files: they may be anywhere, relative to the current folder. Error: a
/// file does not exist; the message begins with its name.
Result<gltf::ImportOptions> importOptions(const ModelArguments& arguments);

/// Prints the warnings about that file on standard error. error: is printed next, so its own warning is left out.
void printWarnings(const std::string& file, const gltf::Messages& messages, const std::string& error = std::string());
/// Only those about clips of other files.
void printClipWarnings(const std::string& file, const gltf::Messages& messages);

/// True for names of files that readModel() reads, by their extension.
bool isModelFormat(const std::string& fileName);

/// Reads a file with OSG's plugins. A warning says if it has characters of osgAnimation. Errors: the file does not
/// exist, or no plugin reads it.
Result<osg::ref_ptr<osg::Node>> readScene(const std::string& fileName, gltf::Report& report);
/// gltf::exportModel() of a scene of that file; an error also says what a stored scene may lack.
Result<std::string> exportScene(const osg::Node& scene, const std::string& fileName, gltf::Report& report);

/// Reads and imports a .gltf or .glb, a file of a format that Assimp reads where the build has it, or a scene that
/// OSG's plugins read, which is exported to glTF first; in the file's own axes if options.noRotation says so. Errors:
/// the file does not exist, is a folder, is empty, cannot be read, or the import refuses it; a file of clips adds none.
/// The warnings before an error are printed: they may explain it.
Result<gltf::ImportedModel> readModel(const std::string& fileName, const gltf::ImportOptions& options);

} // namespace osgGpuAnimation::tool
