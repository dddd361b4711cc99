// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/properties/PropertyPointer.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

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

PropertyMember factor(const char* name, const char* uniform, std::size_t component, std::size_t count = 1,
                      std::array<float, 4> rest = {})
{
    PropertyMember member;
    member.name = name;
    member.count = count;
    member.rest = rest;
    member.uniform = uniform;
    member.component = component;
    return member;
}

PropertyMember upTo(PropertyMember member, float max)
{
    member.max = max;
    return member;
}

PropertyMember from(PropertyMember member, float min)
{
    member.min = min;
    return member;
}

PropertyMember in(const char* group, PropertyMember member)
{
    member.group = group;
    return member;
}

PropertyMember of(Object object, PropertyMember member)
{
    member.object = object;
    return member;
}

void addMaterials(std::vector<PropertyMember>& all)
{
    all.push_back(factor("pbrMetallicRoughness/baseColorFactor", "baseColorFactor", 0, 4, {1, 1, 1, 1}));
    all.push_back(factor("pbrMetallicRoughness/metallicFactor", "materialFactors", 0, 1, {1}));
    all.push_back(factor("pbrMetallicRoughness/roughnessFactor", "materialFactors", 1, 1, {1}));
    all.push_back(from(upTo(factor("normalTexture/scale", "materialFactors", 2, 1, {1}), maxFloat), -maxFloat));
    all.push_back(factor("occlusionTexture/strength", "materialFactors", 3, 1, {1}));
    all.push_back(upTo(factor("alphaCutoff", "alphaCutoff", 0, 1, {0.5f}), maxFloat));
    all.push_back(in("emission", factor("emissiveFactor", "emissiveFactor", 0, 3)));
    all.push_back(in("emission", upTo(factor("extensions/KHR_materials_emissive_strength/emissiveStrength",
                                             "emissiveStrength", 0, 1, {1}),
                                      maxFloat)));
    all.push_back(in("reflection", upTo(factor("extensions/KHR_materials_ior/ior", "", 0, 1, {1.5f}), maxFloat)));
    all.push_back(
        in("reflection",
           upTo(factor("extensions/KHR_materials_specular/specularColorFactor", "", 0, 3, {1, 1, 1}), maxFloat)));
    all.push_back(factor("extensions/KHR_materials_specular/specularFactor", "materialSpecular", 3, 1, {1}));
    all.push_back(factor("extensions/KHR_materials_clearcoat/clearcoatFactor", "materialClearcoat", 0));
    all.push_back(factor("extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", "materialClearcoat", 1));
    all.push_back(from(
        upTo(factor("extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", "materialClearcoat", 2, 1, {1}),
             maxFloat),
        -maxFloat));
    all.push_back(factor("extensions/KHR_materials_sheen/sheenColorFactor", "materialSheen", 0, 3));
    all.push_back(factor("extensions/KHR_materials_sheen/sheenRoughnessFactor", "materialSheen", 3));
    all.push_back(factor("extensions/KHR_materials_transmission/transmissionFactor", "materialTransmission", 0));
    for (const TextureSlot& slot : textureSlots)
        for (const auto& [part, count, rest] :
             {std::tuple("offset", 2, 0.0f), std::tuple("rotation", 1, 0.0f), std::tuple("scale", 2, 1.0f)})
        {
            PropertyMember member;
            member.name = std::string(slot.name) + "/extensions/KHR_texture_transform/" + part;
            member.count = static_cast<std::size_t>(count);
            member.rest = {rest, rest};
            member.min = -maxFloat;
            member.max = maxFloat;
            member.group = member.texture = slot.name;
            member.define = slot.define;
            all.push_back(member);
        }
}

std::vector<PropertyMember> makeMembers()
{
    std::vector<PropertyMember> all;
    addMaterials(all);
    const auto light = [](PropertyMember member) { return of(Object::Light, in("light", std::move(member))); };
    all.push_back(light(upTo(factor("color", "", 0, 3, {1, 1, 1}), maxFloat)));
    all.push_back(light(upTo(factor("intensity", "", 0, 1, {1}), maxFloat)));
    all.push_back(light(upTo(factor("range", "", 0), maxFloat)));
    all.push_back(light(upTo(factor("spot/innerConeAngle", "", 0), halfPi)));
    all.push_back(light(upTo(factor("spot/outerConeAngle", "", 0, 1, {halfPi / 2.0f}), halfPi)));
    all.push_back(of(Object::Camera, from(upTo(factor("perspective/yfov", "", 0), 3.14f), 1e-3f)));
    all.push_back(of(Object::Camera, from(upTo(factor("orthographic/ymag", "", 0), maxFloat), -maxFloat)));
    PropertyMember visible = of(Object::Node, factor("extensions/KHR_node_visibility/visible", "", 0, 1, {1}));
    visible.isBoolean = true;
    all.push_back(visible);
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
