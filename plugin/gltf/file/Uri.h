// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace osgGpuAnimation::gltf
{

// The URIs of buffers and images (glTF 2.0, section 2.8). Errors here are "expected …, found …" without the element.

/// What a data URI holds.
struct DataUri
{
    std::string mimeType; ///< as it is written there; may be empty
    std::vector<unsigned char> bytes;
};

bool isDataUri(std::string_view uri);

/// How many bytes a data URI stands for, told by its length: to be asked before memory is claimed for them.
/// Error: no comma.
Result<std::size_t> bytesOfDataUri(std::string_view uri);

/// Decodes data:[MIME type][;base64],… of any MIME type. Of longer data the first `most` bytes are kept; the rest is
/// looked at for faults only.
/// Errors: no comma, a character that is no base64.
Result<DataUri> decodeDataUri(std::string_view uri, std::size_t most);

/// The path that a relative URI stands for: percent-encoding is resolved, a plus sign is a plus sign.
/// Errors: empty, a scheme or drive letter, an incomplete percent-encoding, an encoded NUL, a backslash.
Result<std::string> decodePath(std::string_view uri);

} // namespace osgGpuAnimation::gltf
