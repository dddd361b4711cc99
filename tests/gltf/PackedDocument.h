// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/LoadDocument.h"
#include "gltf/GlbText.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A .glb made of JSON and blocks of data in its BIN chunk, for data that no writer produces.
class PackedDocument
{
public:
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};

    /// Adds a block of data, aligned to 4; returns where it begins.
    std::size_t add(const void* data, std::size_t bytes)
    {
        _data.resize((_data.size() + 3) / 4 * 4);
        const std::size_t offset = _data.size();
        _data.append(static_cast<const char*>(data), bytes);
        return offset;
    }

    template <typename Number>
    std::size_t add(const std::vector<Number>& numbers)
    {
        return add(numbers.data(), numbers.size() * sizeof(Number));
    }

    /// The number of a new accessor; bufferView -1: none.
    int accessor(const std::string& type, int componentType, std::size_t count, int bufferView, bool normalized = false)
    {
        nlohmann::json made = {{"type", type}, {"componentType", componentType}, {"count", count}};
        if (bufferView >= 0) made["bufferView"] = bufferView;
        if (normalized) made["normalized"] = true;
        json["accessors"].push_back(made);
        return static_cast<int>(json["accessors"].size()) - 1;
    }

    /// Adds a block of data and a buffer view for it; returns the view's number.
    std::size_t addView(const std::string& bytes)
    {
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", add(bytes.data(), bytes.size())}, {"byteLength", bytes.size()}});
        return json["bufferViews"].size() - 1;
    }

    Result<tinygltf::Model> load() const
    {
        Messages messages;
        return load(messages);
    }
    Result<tinygltf::Model> load(Messages& messages) const
    {
        nlohmann::json document = json;
        document["buffers"][0]["byteLength"] = _data.size();
        const std::string glb = packedGlb(document.dump(), _data);
        Result<tinygltf::Model> model = loadDocument(glb, "", {}, messages);
        if (model) keepSeed(glb);
        return model;
    }
    /// The error of loading it; empty without one.
    std::string error() const
    {
        const Result<tinygltf::Model> model = load();
        return model ? "" : model.error().message;
    }

    std::string& data() { return _data; }

private:
    std::string _data;
};

/// The indices of a flat sheet of squares x squares, two triangles each; vertices row after row.
inline std::vector<std::uint32_t> sheetIndices(std::uint32_t squares)
{
    std::vector<std::uint32_t> indices;
    for (std::uint32_t y = 0; y < squares; ++y)
        for (std::uint32_t x = 0; x < squares; ++x)
        {
            const std::uint32_t first = y * (squares + 1) + x, above = first + squares + 1;
            indices.insert(indices.end(), {first, first + 1, above + 1, first, above + 1, above});
        }
    return indices;
}

inline std::vector<float> sheetPositions(std::uint32_t squares)
{
    std::vector<float> positions;
    for (std::uint32_t y = 0; y <= squares; ++y)
        for (std::uint32_t x = 0; x <= squares; ++x)
            positions.insert(positions.end(), {static_cast<float>(x), static_cast<float>(y), 0.25f});
    return positions;
}

} // namespace osgGpuAnimation::gltf
