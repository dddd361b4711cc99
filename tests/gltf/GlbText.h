// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

const std::uint32_t jsonChunk = 0x4E4F534A;
const std::uint32_t binaryChunk = 0x004E4942;

struct GlbChunk
{
    std::uint32_t type = 0;
    std::string data;
};

inline std::string littleEndian(std::uint32_t value)
{
    std::string bytes;
    for (int i = 0; i < 4; ++i)
        bytes += static_cast<char>(value >> 8 * i);
    return bytes;
}

/// The content of a .glb with these chunks, not padded; lengthTooMuch is added to the length of the first one, and tail
/// follows the last one within the length of the file.
inline std::string glb(const std::vector<GlbChunk>& chunks, std::uint32_t version = 2, std::uint32_t lengthTooMuch = 0,
                       const std::string& tail = "")
{
    std::string body;
    for (const GlbChunk& chunk : chunks)
    {
        const std::uint32_t extra = body.empty() ? lengthTooMuch : 0;
        body +=
            littleEndian(static_cast<std::uint32_t>(chunk.data.size()) + extra) + littleEndian(chunk.type) + chunk.data;
    }
    body += tail;
    return "glTF" + littleEndian(version) + littleEndian(static_cast<std::uint32_t>(body.size() + 12)) + body;
}

} // namespace osgGpuAnimation::gltf
