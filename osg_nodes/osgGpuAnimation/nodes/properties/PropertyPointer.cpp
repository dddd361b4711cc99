// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/properties/PropertyPointer.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace osgGpuAnimation
{

namespace
{

using Object = PropertyMember::Object;

constexpr float maxFloat = std::numeric_limits<float>::max();
constexpr float halfPi = 1.57079633f;

/// A texture of a material whose coordinates have a number of their own.
struct TextureSlot
{
    const char* name;
    const char* define; ///< null: its coordinates are number 0
};

constexpr TextureSlot textureSlots[] = {
    {"pbrMetallicRoughness/baseColorTexture", nullptr},
    {"pbrMetallicRoughness/metallicRoughnessTexture", "MATERIAL_METALLIC_ROUGHNESS_MAP"},
    {"normalTexture", "MATERIAL_NORMAL_MAP"},
    {"occlusionTexture", "MATERIAL_OCCLUSION_MAP"},
    {"emissiveTexture", "MATERIAL_EMISSIVE_MAP"},
    {"extensions/KHR_materials_specular/specularTexture", "MATERIAL_SPECULAR_MAP"},
    {"extensions/KHR_materials_specular/specularColorTexture", "MATERIAL_SPECULAR_COLOR_MAP"},
    {"extensions/KHR_materials_clearcoat/clearcoatTexture", "MATERIAL_CLEARCOAT_MAP"},
    {"extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", "MATERIAL_CLEARCOAT_ROUGHNESS_MAP"},
    {"extensions/KHR_materials_clearcoat/clearcoatNormalTexture", "MATERIAL_CLEARCOAT_NORMAL_MAP"},
    {"extensions/KHR_materials_sheen/sheenColorTexture", "MATERIAL_SHEEN_COLOR_MAP"},
    {"extensions/KHR_materials_sheen/sheenRoughnessTexture", "MATERIAL_SHEEN_ROUGHNESS_MAP"},
    {"extensions/KHR_materials_transmission/transmissionTexture", "MATERIAL_TRANSMISSION_MAP"},
};

const std::string emissiveStrength = "extensions/KHR_materials_emissive_strength/emissiveStrength";
const std::string specular = "extensions/KHR_materials_specular/specular";
const std::string clearcoat = "extensions/KHR_materials_clearcoat/clearcoat";
const std::string sheen = "extensions/KHR_materials_sheen/sheen";
const std::string transmission = "extensions/KHR_materials_transmission/transmission";

void addTransforms(std::vector<PropertyMember>& all)
{
    for (const TextureSlot& slot : textureSlots)
        for (const auto& [part, count, rest] :
             {std::tuple("offset", 2u, 0.0f), std::tuple("rotation", 1u, 0.0f), std::tuple("scale", 2u, 1.0f)})
        {
            const std::string name = std::string(slot.name) + "/extensions/KHR_texture_transform/" + part;
            all.push_back({Object::Material, name, count, {rest, rest}, -maxFloat, maxFloat});
            all.back().group = all.back().texture = slot.name;
            all.back().define = slot.define;
        }
}

std::vector<PropertyMember> makeMembers()
{
    std::vector<PropertyMember> all = {
        {Object::Material, "pbrMetallicRoughness/baseColorFactor", 4, {1, 1, 1, 1}, 0, 1, "baseColorFactor"},
        {Object::Material, "pbrMetallicRoughness/metallicFactor", 1, {1}, 0, 1, "materialFactors", 0},
        {Object::Material, "pbrMetallicRoughness/roughnessFactor", 1, {1}, 0, 1, "materialFactors", 1},
        {Object::Material, "normalTexture/scale", 1, {1}, -maxFloat, maxFloat, "materialFactors", 2},
        {Object::Material, "occlusionTexture/strength", 1, {1}, 0, 1, "materialFactors", 3},
        {Object::Material, "alphaCutoff", 1, {0.5f}, 0, maxFloat, "alphaCutoff"},
        {Object::Material, "emissiveFactor", 3, {}, 0, 1, "emissiveFactor", 0, "emission"},
        {Object::Material, emissiveStrength, 1, {1}, 0, maxFloat, "emissiveStrength", 0, "emission"},
        {Object::Material, "extensions/KHR_materials_ior/ior", 1, {1.5f}, 0, maxFloat, "", 0, "reflection"},
        {Object::Material, specular + "ColorFactor", 3, {1, 1, 1}, 0, maxFloat, "", 0, "reflection"},
        {Object::Material, specular + "Factor", 1, {1}, 0, 1, "materialSpecular", 3},
        {Object::Material, clearcoat + "Factor", 1, {}, 0, 1, "materialClearcoat", 0},
        {Object::Material, clearcoat + "RoughnessFactor", 1, {}, 0, 1, "materialClearcoat", 1},
        {Object::Material, clearcoat + "NormalTexture/scale", 1, {1}, -maxFloat, maxFloat, "materialClearcoat", 2},
        {Object::Material, sheen + "ColorFactor", 3, {}, 0, 1, "materialSheen", 0},
        {Object::Material, sheen + "RoughnessFactor", 1, {}, 0, 1, "materialSheen", 3},
        {Object::Material, transmission + "Factor", 1, {}, 0, 1, "materialTransmission"},
        {Object::Light, "color", 3, {1, 1, 1}, 0, maxFloat, "", 0, "light"},
        {Object::Light, "intensity", 1, {1}, 0, maxFloat, "", 0, "light"},
        {Object::Light, "range", 1, {}, 0, maxFloat, "", 0, "light"},
        {Object::Light, "spot/innerConeAngle", 1, {}, 0, halfPi, "", 0, "light"},
        {Object::Light, "spot/outerConeAngle", 1, {halfPi / 2.0f}, 0, halfPi, "", 0, "light"},
        {Object::Camera, "perspective/yfov", 1, {}, 1e-3f, 3.14f},
        {Object::Camera, "orthographic/ymag", 1, {}, -maxFloat, maxFloat},
        {Object::Node, "extensions/KHR_node_visibility/visible", 1, {1}, 0, 1, "", 0, "", true},
    };
    addTransforms(all);
    return all;
}

/// The pointer's part before the index, by object.
constexpr std::string_view prefixes[] = {"/materials/", "/extensions/KHR_lights_punctual/lights/", "/cameras/",
                                         "/nodes/"};

} // namespace

const std::vector<PropertyMember>& PropertyMember::all()
{
    static const std::vector<PropertyMember> members = makeMembers();
    return members;
}

std::optional<int> parsePointerIndex(std::string_view text)
{
    const bool areDigits = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (text.empty() || text.size() > 9 || !areDigits || (text.size() > 1 && text.front() == '0')) return std::nullopt;
    int index = 0;
    for (const char digit : text)
        index = 10 * index + (digit - '0');
    return index;
}

std::optional<PropertyPointer> PropertyPointer::parse(std::string_view pointer)
{
    for (std::size_t object = 0; object < std::size(prefixes); ++object)
    {
        if (pointer.substr(0, prefixes[object].size()) != prefixes[object]) continue;
        const std::string_view rest = pointer.substr(prefixes[object].size());
        const std::size_t slash = std::min(rest.find('/'), rest.size());
        const std::optional<int> index = parsePointerIndex(rest.substr(0, slash));
        if (!index || slash == rest.size()) return std::nullopt;
        for (const PropertyMember& member : PropertyMember::all())
            if (static_cast<std::size_t>(member.object) == object && rest.substr(slash + 1) == member.name)
                return PropertyPointer{&member, *index};
        return std::nullopt;
    }
    return std::nullopt;
}

std::string PropertyPointer::text(const PropertyMember& member, int index)
{
    return std::string(prefixes[static_cast<std::size_t>(member.object)]) + std::to_string(index) + '/' + member.name;
}

} // namespace osgGpuAnimation
