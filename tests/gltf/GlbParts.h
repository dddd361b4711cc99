// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The parts of a .glb that a writer of ours has made: one buffer, tightly packed views.
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

} // namespace osgGpuAnimation::gltf
