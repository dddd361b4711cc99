// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/LoopMode.h>

#include <cstddef>
#include <optional>
#include <string>

namespace osgGpuAnimation::gltf
{

/// What a caller may ask of an import, and the limits that keep a file from any origin harmless.
struct ImportOptions
{
    std::optional<std::string> clip; ///< name, or index where no clip has that name; default: the first
    std::optional<double> start;     ///< seconds into that clip, held to its duration; default: where its speed begins
    double speed = 1.0;              ///< of that clip, see AnimationLayer::setSpeed
    LoopMode loopMode = LoopMode::Loop;
    double fadeSeconds = 0.3;       ///< of the keys' crossfades, see CharacterKeys
    std::optional<double> compact;  ///< compact clips, see CompactedCharacter: off by at most that fraction; above 0
    double pixelError = 0.0;        ///< see AnimatedCharacter::setPixelError; 0 or more
    bool noKeys = false;            ///< no keys for viewers on the character
    std::optional<int> scene;       ///< default: the file's own, else 0
    bool noRotation = false;        ///< keep glTF's +Y up; default: turn to OSG's +Z up at the root
    bool allowOutsideFiles = false; ///< let URIs leave the model's folder

    std::size_t maxJsonBytes = std::size_t(512) << 20; ///< of the JSON text, data URIs and all
    std::size_t maxJsonDepth = 256;
    std::size_t maxNodeDepth = 4096;                       ///< nodes from a root to a leaf
    std::size_t maxElements = 1u << 24;                    ///< of any one array of the document
    std::size_t maxDocumentBytes = std::size_t(448) << 20; ///< what the JSON becomes, without the data it points to
    std::size_t maxDecodedBytes = std::size_t(2) << 30;    ///< buffers, accessors and images, all together
};

} // namespace osgGpuAnimation::gltf
