// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/EncodedPicture.h"
#include "gltf/ImportedFile.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A ModelBuilder whose channels may have a pointer as their path (KHR_animation_pointer).
///
///     PointerFile file;
///     file.quad("red", 0, 0, file.material("red", {1, 0, 0, 1}));
///     file.animation("fade");
///     file.animate("/materials/0/pbrMetallicRoughness/baseColorFactor", TINYGLTF_TYPE_VEC4, {1, 0, 0, 1, 0, 0, 1, 1});
class PointerFile : public ModelBuilder
{
public:
    /// An unlit material of that linear colour; roughness 1, no metal.
    int material(const std::string& name, const std::vector<double>& color, bool isLit = false)
    {
        tinygltf::Material made;
        made.name = name;
        made.pbrMetallicRoughness.baseColorFactor = color;
        made.pbrMetallicRoughness.metallicFactor = 0.0;
        made.emissiveFactor = {0.0, 0.0, 0.0};
        if (!isLit) made.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
        model.materials.push_back(made);
        return static_cast<int>(model.materials.size()) - 1;
    }

    /// A node with a square of 2 units around (x, y, 0), which faces +Z. Its texture coordinates show a picture once.
    int quad(const std::string& name, float x, float y, int material, int parent = -1)
    {
        const int made =
            mesh({{"POSITION",
                   floats(TINYGLTF_TYPE_VEC3, {x - 1, y - 1, 0, x + 1, y - 1, 0, x - 1, y + 1, 0, x + 1, y + 1, 0})},
                  {"NORMAL", floats(TINYGLTF_TYPE_VEC3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})},
                  {"TEXCOORD_0", floats(TINYGLTF_TYPE_VEC2, {0, 1, 1, 1, 0, 0, 1, 0})}},
                 TINYGLTF_MODE_TRIANGLE_STRIP);
        primitive(made).material = material;
        return node(name, parent, made);
    }

    /// Animates a property from 0 s to 1 s (and more, if there are more values).
    void animate(const std::string& pointer, int type, const std::vector<float>& values,
                 const std::string& interpolation = "LINEAR")
    {
        const std::size_t components = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(std::uint32_t(type)));
        std::vector<float> times;
        while (times.size() * components * (interpolation == "CUBICSPLINE" ? 3 : 1) < values.size())
            times.push_back(static_cast<float>(times.size()));
        channel(-1, pointer, times, type, values, interpolation);
    }

    /// Animates the visibility of a node: one value a second.
    void show(int node, const std::vector<unsigned int>& isVisible)
    {
        animate("/nodes/" + std::to_string(node) + "/extensions/KHR_node_visibility/visible", TINYGLTF_TYPE_SCALAR,
                std::vector<float>(isVisible.size()), "STEP");
        model.animations.back().samplers.back().output =
            integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, isVisible);
    }

    nlohmann::json document() const
    {
        nlohmann::json made = nlohmann::json::parse(text());
        for (nlohmann::json& animation : made["animations"])
            for (nlohmann::json& channel : animation["channels"])
            {
                nlohmann::json& target = channel["target"];
                const std::string path = target["path"];
                if (path.empty() || path[0] != '/') continue;
                target = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", path}}}}}};
            }
        return made;
    }
};

/// The import of a document, which causes no warning.
inline ImportedModel importedFrom(const nlohmann::json& document, const ImportOptions& options = {})
{
    const ImportedModel model = imported(document.dump(), options);
    expectWarnings(model, {});
    return model;
}

} // namespace osgGpuAnimation::gltf
