// SPDX-License-Identifier: MIT
#include "fuzz/Seed.h"

#include "plugin/GlbText.h"

#include <cstddef>

namespace osgGpuAnimation::gltf
{

namespace
{

std::string base64(const std::string& bytes)
{
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        unsigned int three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

} // namespace

std::string Seed::glb() const
{
    std::string text = json.dump(), data = binary;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4);
    if (data.empty()) return gltf::glb({{jsonChunk, text}});
    return gltf::glb({{jsonChunk, text}, {binaryChunk, data}});
}

std::string Seed::gltf() const
{
    nlohmann::json document = json;
    if (!binary.empty()) document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(binary);
    return document.dump();
}

} // namespace osgGpuAnimation::gltf
