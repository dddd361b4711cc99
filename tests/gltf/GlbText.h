// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Uri.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
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

/// A .glb of that JSON and of data in a BIN chunk, both padded.
inline std::string packedGlb(std::string json, std::string binary)
{
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    return glb({{jsonChunk, json}, {binaryChunk, binary}});
}

/// The parts of a .glb with one buffer and tightly packed views, to read or to change.
struct GlbParts
{
    nlohmann::json json = nlohmann::json::object();
    std::string binary;

    GlbParts() = default;
    explicit GlbParts(const std::string& glb)
    {
        std::uint32_t length = 0;
        std::memcpy(&length, &glb[12], 4);
        json = nlohmann::json::parse(glb.substr(20, length));
        if (glb.size() > 28 + length) binary = glb.substr(28 + length);
    }

    std::string whole() const { return packedGlb(json.dump(), binary); }

    /// The bytes of a buffer view.
    std::string bytes(const nlohmann::json& view) const
    {
        const nlohmann::json& made = json["bufferViews"][view.get<std::size_t>()];
        return binary.substr(made["byteOffset"].get<std::size_t>(), made["byteLength"].get<std::size_t>());
    }

    /// The numbers of an accessor of floats or unsigned integers.
    std::vector<double> numbers(const nlohmann::json& accessor) const
    {
        const nlohmann::json& made = json["accessors"][accessor.get<std::size_t>()];
        const std::string all = bytes(made["bufferView"]);
        const std::size_t size = made["componentType"] == 5123 ? 2 : 4;
        std::vector<double> found;
        for (std::size_t at = 0; at + size <= all.size(); at += size)
        {
            float real = 0.0f;
            std::uint32_t whole = 0;
            std::memcpy(&whole, &all[at], size);
            std::memcpy(&real, &whole, 4);
            found.push_back(made["componentType"] == 5126 ? static_cast<double>(real) : static_cast<double>(whole));
        }
        return found;
    }

    /// Of an attribute of a primitive of the first mesh; empty without it.
    std::vector<double> attribute(const char* name, std::size_t primitive = 0) const
    {
        const nlohmann::json& all = json["meshes"][0]["primitives"][primitive]["attributes"];
        return all.contains(name) ? numbers(all[name]) : std::vector<double>();
    }
};

/// Keeps a file that a test has read as a seed of fuzz_glb or fuzz_gltf, in the folder that the environment variable
/// names (see fuzz/CMakeLists.txt); without it does nothing. A .gltf with its data inside is also kept as a .glb.
inline void keepSeed(const std::string& content)
{
    const char* const folder = std::getenv("OSGGPUANIMATION_FUZZ_SEEDS");
    if (!folder || content.size() > 16384) return;
    const bool isGlb = content.rfind("glTF", 0) == 0;
    const std::filesystem::path kind = std::filesystem::path(folder) / (isGlb ? "glb" : "gltf");
    std::filesystem::create_directories(kind);
    std::ofstream(kind / std::to_string(std::hash<std::string>()(content)), std::ios::binary) << content;
    nlohmann::json document = isGlb ? nullptr : nlohmann::json::parse(content, nullptr, false);
    const std::string uri = document.is_object() ? document.value("/buffers/0/uri"_json_pointer, "") : "";
    if (!isDataUri(uri)) return;
    const DataUri data = decodeDataUri(uri, content.size()).value();
    document["buffers"][0].erase("uri");
    keepSeed(packedGlb(document.dump(), std::string(data.bytes.begin(), data.bytes.end())));
}

} // namespace osgGpuAnimation::gltf
