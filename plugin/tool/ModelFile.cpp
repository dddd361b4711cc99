// SPDX-License-Identifier: MIT
#include "tool/ModelFile.h"

#include "gltf/file/ModelBytes.h"
#include "gltf/file/ProgressLine.h"

#include <osgDB/FileNameUtils>

#include <filesystem>

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
