// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace osgGpuAnimation::gltf
{

/// What a caller may ask of an import, and the limits that keep a file from any origin harmless.
struct ImportOptions
{
    std::optional<std::string> clip; ///< name, or index where no clip has that name; default: the first
    std::optional<int> scene;        ///< default: the file's own, else 0
    bool noRotation = false;         ///< keep glTF's +Y up; default: turn to OSG's +Z up at the root
    bool allowOutsideFiles = false;  ///< let URIs leave the model's folder

    std::size_t maxJsonDepth = 256;
    std::size_t maxNodeDepth = 4096;                    ///< nodes from a root to a leaf
    std::size_t maxElements = 1u << 24;                 ///< of any one array of the document
    std::size_t maxDecodedBytes = std::size_t(2) << 30; ///< buffers, accessors and images, all together
};

} // namespace osgGpuAnimation::gltf
