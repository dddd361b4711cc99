// SPDX-License-Identifier: MIT
#include "tool/ModelFile.h"

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

} // namespace

Result<gltf::ImportOptions> importOptions(const std::vector<std::string>& clipsFiles)
{
    gltf::ImportOptions options;
    options.allowOutsideClips = true;
    for (const std::string& file : clipsFiles)
    {
        std::error_code failure;
        const std::filesystem::path path = std::filesystem::canonical(file, failure);
        if (failure) return Error{file + ": there is no such file"};
        options.clipsFiles.push_back(path.string());
    }
    return options;
}

void printClipWarnings(const gltf::ImportedModel& model)
{
    for (const std::string& warning : model.messages.warnings)
        if (warning.rfind("clips ", 0) == 0) std::cerr << "osggpuanim: " << warning << std::endl;
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
    const Result<std::string> bytes = gltf::readModelFile(fileName, options);
    if (!bytes) return bytes.error();
    Result<gltf::ImportedModel> model = gltf::importModel(bytes.value(), fileName, options);
    if (!model && !isCalledGltf(fileName)) return Error{"the file is neither .gltf nor .glb: " + model.error().message};
    return model;
}

} // namespace osgGpuAnimation::tool
