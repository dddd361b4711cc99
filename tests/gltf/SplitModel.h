// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/GlbText.h"

#include <nlohmann/json.hpp>

#include <string>

namespace osgGpuAnimation::gltf
{

/// A .glb with a JSON document for tests to change: as a whole, or without animations.
class SplitModel
{
public:
    /// glbBytes: a .glb with a JSON chunk and a BIN chunk.
    explicit SplitModel(const std::string& glbBytes)
    {
        const std::size_t jsonBytes = numberAt(glbBytes, 12);
        _document = nlohmann::json::parse(glbBytes.substr(20, jsonBytes));
        _binary = glbBytes.substr(28 + jsonBytes, numberAt(glbBytes, 20 + jsonBytes));
    }

    nlohmann::json& document() { return _document; }
    std::string& binary() { return _binary; } ///< the BIN chunk

    std::string mesh() const
    {
        nlohmann::json mesh = _document;
        mesh.erase("animations");
        return glbOf(mesh);
    }
    std::string whole() const { return glbOf(_document); }

private:
    static std::size_t numberAt(const std::string& bytes, std::size_t at)
    {
        std::size_t number = 0;
        for (std::size_t i = 4; i-- > 0;)
            number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
        return number;
    }
    std::string glbOf(const nlohmann::json& document) const
    {
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        return glb({{jsonChunk, text}, {binaryChunk, _binary}});
    }

    nlohmann::json _document;
    std::string _binary;
};

} // namespace osgGpuAnimation::gltf
