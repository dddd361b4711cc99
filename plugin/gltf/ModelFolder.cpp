// SPDX-License-Identifier: MIT
#include "gltf/ModelFolder.h"

#include "gltf/ElementName.h"
#include "gltf/Uri.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

namespace fs = std::filesystem;

Error outside(const std::string& path)
{
    return Error{"expected a file in the model's folder or below it, found " + quoted(path) +
                 " (the option allowOutsideFiles lets it be read)"};
}

bool leavesFolder(const fs::path& relative)
{
    const fs::path normal = relative.lexically_normal();
    return relative.is_absolute() || (normal.begin() != normal.end() && *normal.begin() == "..");
}

bool isBelow(const fs::path& file, const fs::path& folder)
{
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

} // namespace

ModelFolder::ModelFolder(std::string modelFile, bool allowOutsideFiles)
    : _modelFile(std::move(modelFile)), _allowOutsideFiles(allowOutsideFiles)
{
}

Result<RegularFile> ModelFolder::open(std::string_view uri) const
{
    const Result<std::string> path = decodePath(uri);
    if (!path) return path.error();
    if (_modelFile.empty())
        return Error{"expected data in the model itself, which came without a file name, found " + quoted(uri)};
    const Result<std::string> resolved = resolve(path.value());
    if (!resolved) return resolved.error();
    Result<RegularFile> file = RegularFile::open(resolved.value());
    if (file && file.value().isSameAs(_modelFile))
        return Error{"expected a file of its own, found the model file itself"};
    return file;
}

Result<std::string> ModelFolder::resolve(const std::string& path) const
{
    // First by the text alone: what lies outside is not even asked for.
    if (!_allowOutsideFiles && leavesFolder(path)) return outside(path);
    fs::path folder = fs::path(_modelFile).parent_path();
    if (folder.empty()) folder = ".";
    std::error_code error;
    const fs::path file = fs::canonical(folder / path, error);
    if (error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory)
        return Error{"expected a file, found that " + quoted(path) + " does not exist"};
    if (error) return Error{"expected a file, found " + quoted(path) + ": " + error.message()};
    if (_allowOutsideFiles) return file.string();
    const fs::path home = fs::canonical(folder, error);
    if (error) return Error{"the model's folder cannot be found: " + error.message()};
    if (!isBelow(file, home)) return outside(path);
    return file.string();
}

} // namespace osgGpuAnimation::gltf
