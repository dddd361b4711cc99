// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/detail/RegularFile.h>
#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

// The URIs of buffers and images (glTF 2.0, section 2.8). Errors here are "expected …, found …" without the element.

/// The content of a data URI.
struct DataUri
{
    std::string mimeType; ///< as the URI has it; may be empty
    std::vector<unsigned char> bytes;
};

bool isDataUri(std::string_view uri);

/// The number of bytes that a data URI decodes to, computed from its length before any allocation.
/// Error: no comma.
Result<std::size_t> bytesOfDataUri(std::string_view uri);

/// Decodes data:[MIME type][;base64],… of any MIME type. Keeps the first `max` bytes; checks the rest for faults.
/// Errors: no comma, a character that is not base64.
Result<DataUri> decodeDataUri(std::string_view uri, std::size_t max);

/// The path of a relative URI: percent-encoding is decoded, a plus sign stays a plus sign.
/// Errors: empty, a scheme or drive letter, an incomplete percent-encoding, an encoded NUL, a backslash.
Result<std::string> decodePath(std::string_view uri);

/// True for a file in the folder or below it. Both: canonical.
bool isBelow(const std::filesystem::path& file, const std::filesystem::path& folder);

/// The folder that external files of a model must lie in or below, after symbolic links are resolved, unless the caller
/// allows more. A model from a stream has no folder and no external files.
class ModelFolder
{
public:
    /// modelFile: may be empty (a stream).
    ModelFolder(std::string modelFile, bool allowOutsideFiles)
        : _modelFile(std::move(modelFile)), _allowOutsideFiles(allowOutsideFiles)
    {
    }

    /// Opens the file of a URI that is not a data URI. Errors are `expected …, found …` or name the file.
    Result<RegularFile> open(std::string_view uri) const;

    /// The same for a path in place of a URI.
    Result<RegularFile> openPath(const std::string& path) const;
    /// The path, without symbolic links, of a file that the user named: relative to the folder, else to the current
    /// one. Errors: it does not exist, is outside the folder, or is the model file itself.
    Result<std::string> find(const std::string& path) const;

private:
    std::string _modelFile;
    bool _allowOutsideFiles;
};

} // namespace osgGpuAnimation::gltf
