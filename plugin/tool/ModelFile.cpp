// SPDX-License-Identifier: MIT
#include "ModelFile.h"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace osgGpuAnimation::tool
{

Result<gltf::ImportedModel> readModel(const std::string& fileName, const gltf::ImportOptions& options)
{
    std::error_code failure;
    const std::filesystem::file_status status = std::filesystem::status(fileName, failure);
    if (!std::filesystem::exists(status)) return Error{"there is no such file"};
    if (std::filesystem::is_directory(status)) return Error{"is a folder, not a .gltf or .glb file"};
    // A pipe or a device could block for ever, or never end.
    if (!std::filesystem::is_regular_file(status)) return Error{"is not a regular file"};

    std::ifstream file(fileName, std::ios::binary);
    std::ostringstream content;
    if (!file || (std::filesystem::file_size(fileName, failure) > 0 && !(content << file.rdbuf())))
        return Error{"cannot be read"};
    const std::string bytes = content.str();
    if (bytes.empty()) return Error{"is empty"};
    return gltf::importModel(bytes, fileName, options);
}

} // namespace osgGpuAnimation::tool
