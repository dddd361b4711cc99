// SPDX-License-Identifier: MIT
#include "tool/ModelFile.h"

#ifdef OSGGPUANIMATION_ASSIMP
#include "assimp/AssimpFile.h"
#endif
#include "gltf/file/ModelBytes.h"
#include "gltf/file/ProgressLine.h"

#include <osgDB/FileNameUtils>

#include <filesystem>
#include <iostream>

namespace osgGpuAnimation::tool
{

namespace
{

bool isCalledGltf(const std::string& fileName)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(fileName);
    return extension == "gltf" || extension == "glb";
}

/// The file as glTF; of another format where Assimp reads it.
Result<std::string> readGltf(const std::string& fileName, const gltf::ImportOptions& options, gltf::Messages& messages)
{
#ifdef OSGGPUANIMATION_ASSIMP
    if (!isCalledGltf(fileName) && assimp::isFormat(osgDB::getLowerCaseFileExtension(fileName)))
    {
        gltf::Report report(messages);
        return assimp::readAsGlb(fileName, options, report);
    }
#else
    static_cast<void>(messages);
#endif
    return gltf::readModelFile(fileName, options);
}

} // namespace

Result<gltf::ImportOptions> importOptions(const std::vector<std::string>& clipsFiles, const std::string& clipJoints)
{
    gltf::ImportOptions options;
    options.allowOutsideClips = true;
#ifdef OSGGPUANIMATION_ASSIMP
    options.otherFormats = assimp::readAsGlb;
#endif
    std::error_code failure;
    for (const std::string& file : clipsFiles)
    {
        options.clipsFiles.push_back(std::filesystem::canonical(file, failure).string());
        if (failure) return Error{file + ": there is no such file"};
    }
    if (clipJoints.empty()) return options;
    options.clipJoints = std::filesystem::canonical(clipJoints, failure).string();
    if (failure) return Error{clipJoints + ": there is no such file"};
    return options;
}

void printClipWarnings(const gltf::ImportedModel& model)
{
    for (const std::string& warning : model.messages.warnings)
        if (warning.rfind("clips ", 0) == 0 || warning.rfind("clipJoints ", 0) == 0)
            std::cerr << "osggpuanim: " << warning << std::endl;
}

bool isModelFormat(const std::string& fileName)
{
#ifdef OSGGPUANIMATION_ASSIMP
    if (assimp::isFormat(osgDB::getLowerCaseFileExtension(fileName))) return true;
#endif
    return isCalledGltf(fileName);
}

Result<gltf::ImportedModel> readModel(const std::string& fileName, const gltf::ImportOptions& options)
{
    std::error_code failure;
    const std::filesystem::file_status status = std::filesystem::status(fileName, failure);
    if (!std::filesystem::exists(status)) return Error{"there is no such file"};
    if (std::filesystem::is_directory(status)) return Error{"is a folder, not a .gltf or .glb file"};
    // Reading a pipe or a device could block or never end.
    if (!std::filesystem::is_regular_file(status)) return Error{"is not a regular file"};

    const gltf::ProgressLine progress("reading " + osgDB::getSimpleFileName(fileName));
    gltf::Messages messages;
    const Result<std::string> bytes = readGltf(fileName, options, messages);
    if (!bytes) return bytes.error();
    Result<gltf::ImportedModel> imported = gltf::importModel(bytes.value(), fileName, options);
    if (!imported && !isCalledGltf(fileName))
        return Error{"the file is neither .gltf nor .glb: " + imported.error().message};
    if (!imported || (messages.warnings.empty() && messages.notes.empty())) return imported;
    gltf::ImportedModel model = imported.value();
    const auto putFirst = [](std::vector<std::string>& all, const std::vector<std::string>& first)
    { all.insert(all.begin(), first.begin(), first.end()); };
    putFirst(model.messages.warnings, messages.warnings);
    putFirst(model.messages.notes, messages.notes);
    return model;
}

} // namespace osgGpuAnimation::tool
