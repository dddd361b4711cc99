// SPDX-License-Identifier: MIT
#include "gltf/document/DocumentRules.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>

// Lights, cameras and variants: a faulty element costs only itself.

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::string_view lightExtension = "KHR_lights_punctual";
constexpr std::string_view variantExtension = "KHR_materials_variants";

using Fault = std::optional<Error>;

void dropAllBut(const JsonValue& object, std::string_view first, std::string_view second = {})
{
    for (const JsonValue& member : object)
        if (member.key() != first && member.key() != second) member.dropFrom(object);
}

/// A list that is a member of the extension; missing without it. A member that is no list costs the extension.
JsonValue listOf(const JsonValue& extensions, std::string_view extensionName, std::string_view member,
                 const std::string& name, const char* consequence, Report& report)
{
    const JsonValue extension = extensions[extensionName], list = extension[member];
    if (!extension || list.is(JsonTree::Type::Array)) return list;
    report.warn(fault(name, "an array", list.description()).message + "; " + consequence);
    extension.dropFrom(extensions);
    return JsonValue();
}

/// Elements at fault lose their members and keep their places. check: Fault(const JsonValue&, const std::string& name).
template <typename Check>
void checkEach(const JsonValue& list, const std::string& name, const char* consequence, Report& report,
               const Check& check)
{
    std::size_t index = 0;
    for (const JsonValue& element : list)
    {
        const Fault wrong = check(element, elementName(name, index++));
        if (!wrong) continue;
        report.warn(wrong->message + "; " + consequence);
        element.dropMembers();
    }
}

constexpr double maxFloat = 3.4028234663852886e38;
constexpr double halfPi = 1.5707964; // pi / 2 as a float, rounded up
constexpr double pi = 3.14159265358979;

constexpr double aboveZero = std::numeric_limits<double>::denorm_min();

struct NumberRule
{
    std::string_view member;
    double min, max;
    const char* expected;
};
constexpr NumberRule lightNumbers[] = {
    {"intensity", 0.0, maxFloat, "a number from 0"},
    {"range", aboveZero, maxFloat, "a number above 0"},
};
constexpr NumberRule coneNumbers[] = {
    {"innerConeAngle", 0.0, halfPi, "an angle from 0, below pi / 2"},
    {"outerConeAngle", aboveZero, halfPi, "an angle above 0, at most pi / 2"},
};
constexpr double defaultOuterAngle = 0.7853981633974483; // pi / 4

/// A fault for a member of another type. A number out of range is left out.
template <std::size_t count>
Fault checkNumbers(const JsonValue& object, const NumberRule (&rules)[count], const std::string& name, Report& report)
{
    for (const NumberRule& rule : rules)
    {
        const JsonValue value = object[rule.member];
        if (!value) continue;
        const std::string member = name + '.' + std::string(rule.member);
        if (!value.is(JsonTree::Type::Number)) return fault(member, rule.expected, value.description());
        if (value.number() >= rule.min && value.number() <= rule.max) continue;
        report.warn(fault(member, rule.expected, value.description()).message + "; left out");
        value.dropFrom(object);
    }
    return std::nullopt;
}

Fault checkColor(const JsonValue& light, const std::string& name)
{
    const JsonValue color = light["color"];
    if (!color) return std::nullopt;
    const char* const expected = "3 numbers from 0";
    if (!color.is(JsonTree::Type::Array) || color.size() != 3)
        return fault(name + ".color", expected, color.description());
    for (const JsonValue& channel : color)
        if (!channel.is(JsonTree::Type::Number) || channel.number() < 0.0 || channel.number() > maxFloat)
            return fault(name + ".color", expected, channel.description());
    return std::nullopt;
}

Fault checkCone(const JsonValue& light, const std::string& name, Report& report)
{
    const JsonValue spot = light["spot"];
    if (!spot.is(JsonTree::Type::Object)) return fault(name + ".spot", "an object", spot.description());
    const Fault wrong = checkNumbers(spot, coneNumbers, name + ".spot", report);
    if (wrong) return wrong;
    const JsonValue inner = spot["innerConeAngle"], outer = spot["outerConeAngle"];
    if (inner && inner.number() >= (outer ? outer.number() : defaultOuterAngle))
    {
        report.warn(name + ".spot.innerConeAngle: expected an angle below outerConeAngle, found " +
                    inner.description() + "; left out");
        inner.dropFrom(spot);
    }
    return std::nullopt;
}

/// Why the light cannot be used.
Fault checkLight(const JsonValue& light, const std::string& name, Report& report)
{
    if (!light.is(JsonTree::Type::Object)) return fault(name, "an object", light.description());
    const JsonValue type = light["type"];
    const std::string_view text = type.is(JsonTree::Type::String) ? type.text() : std::string_view();
    if (text != "directional" && text != "point" && text != "spot")
        return fault(name + ".type", "directional, point or spot", type.description());
    const JsonValue lightName = light["name"];
    if (lightName && !lightName.is(JsonTree::Type::String)) lightName.dropFrom(light);
    Fault wrong = checkColor(light, name);
    if (!wrong) wrong = checkNumbers(light, lightNumbers, name, report);
    if (!wrong && text == "spot") return checkCone(light, name, report);
    if (const JsonValue spot = light["spot"]) spot.dropFrom(light);
    return wrong;
}

/// Returns how many places the list has.
std::size_t checkLights(const JsonValue& extensions, Report& report)
{
    const std::string name = "extensions.KHR_lights_punctual.lights";
    const JsonValue lights = listOf(extensions, lightExtension, "lights", name, "no light is read", report);
    checkEach(lights, name, "the light is left out", report,
              [&](const JsonValue& light, const std::string& place) { return checkLight(light, place, report); });
    return lights ? lights.size() : 0;
}

void checkNodeLight(const JsonValue& node, std::size_t index, std::size_t lights, Report& report)
{
    const JsonValue extensions = node["extensions"], extension = extensions[lightExtension];
    if (!extension) return;
    const JsonValue light = extension["light"];
    dropAllBut(extension, "light");
    if (light.isIndexBelow(lights)) return;
    report.warn(fault(elementName("nodes", index) + ".extensions.KHR_lights_punctual.light",
                      "an index below " + std::to_string(lights) + " of the file's lights", light.description())
                    .message +
                "; left out");
    extension.dropFrom(extensions);
}

/// Why the camera cannot be used.
Fault checkCamera(const JsonValue& camera, const std::string& name)
{
    const JsonValue type = camera["type"];
    if (!type) return fault(name + ".type", "perspective or orthographic", "nothing");
    const bool isPerspective = type.text() == "perspective";
    const JsonValue size = isPerspective ? camera["perspective"]["yfov"] : camera["orthographic"]["ymag"];
    if (isPerspective && !(size && size.number() > 0.0 && size.number() < pi))
        return fault(name + ".perspective.yfov", "an angle above 0, below pi", size.description());
    if (!isPerspective && !(size && size.number() != 0.0))
        return fault(name + ".orthographic.ymag", "a number, not 0", size.description());
    return std::nullopt;
}

/// Returns how many places the list has.
std::size_t checkVariants(const JsonValue& extensions, Report& report)
{
    const std::string name = "extensions.KHR_materials_variants.variants";
    const JsonValue variants = listOf(extensions, variantExtension, "variants", name, "no variant is read", report);
    if (!variants) return 0;
    dropAllBut(extensions[variantExtension], "variants");
    const auto check = [](const JsonValue& variant, const std::string& place) -> Fault
    {
        const JsonValue text = variant["name"];
        if (!text.is(JsonTree::Type::String)) return fault(place + ".name", "a text", text.description());
        dropAllBut(variant, "name");
        return std::nullopt;
    };
    checkEach(variants, name, "the variant gets another name", report, check);
    return variants.size();
}

struct Counts
{
    std::size_t variants = 0;
    std::size_t materials = 0;
};

/// Why the mapping cannot be used. taken: the variants of the earlier mappings; those of a usable one are added.
Fault checkMapping(const JsonValue& mapping, const std::string& name, const Counts& counts,
                   std::unordered_set<std::size_t>& taken)
{
    if (!mapping.is(JsonTree::Type::Object)) return fault(name, "an object", mapping.description());
    const JsonValue material = mapping["material"], variants = mapping["variants"];
    if (!material.isIndexBelow(counts.materials))
        return fault(name + ".material",
                     "an index below " + std::to_string(counts.materials) + " of the file's materials",
                     material.description());
    if (!variants.is(JsonTree::Type::Array)) return fault(name + ".variants", "an array", variants.description());
    std::unordered_set<std::size_t> own;
    for (const JsonValue& variant : variants)
    {
        if (!variant.isIndexBelow(counts.variants))
            return fault(name + ".variants",
                         "indices below " + std::to_string(counts.variants) + " of the file's variants",
                         variant.description());
        const auto index = static_cast<std::size_t>(variant.number());
        if (taken.count(index) || !own.insert(index).second)
            return fault(name + ".variants", "each variant once", variant.description() + " again");
    }
    taken.insert(own.begin(), own.end());
    return std::nullopt;
}

void checkPrimitive(const JsonValue& primitive, const PrimitiveName& name, const Counts& counts, Report& report)
{
    const JsonValue extensions = primitive["extensions"], extension = extensions[variantExtension];
    if (!extension) return;
    if (counts.variants == 0) return extension.dropFrom(extensions); // one warning has named that
    const std::string place = name.text() + ".extensions.KHR_materials_variants.mappings";
    const JsonValue mappings = listOf(extensions, variantExtension, "mappings", place, "left out", report);
    if (!mappings) return;
    dropAllBut(extension, "mappings");
    std::unordered_set<std::size_t> taken;
    const auto check = [&](const JsonValue& mapping, const std::string& mappingName)
    {
        const Fault wrong = checkMapping(mapping, mappingName, counts, taken);
        if (!wrong) dropAllBut(mapping, "material", "variants");
        return wrong;
    };
    checkEach(mappings, place, "the mapping is left out", report, check);
}

} // namespace

void checkViewRules(const JsonValue& document, Report& report)
{
    const std::size_t lights = checkLights(document["extensions"], report);
    std::size_t index = 0;
    for (const JsonValue& node : document["nodes"])
        checkNodeLight(node, index++, lights, report);
    checkEach(document["cameras"], "cameras", "the camera is left out", report, checkCamera);
}

void checkVariantRules(const JsonValue& document, Report& report)
{
    Counts counts;
    counts.variants = checkVariants(document["extensions"], report);
    if (const JsonValue materials = document["materials"]) counts.materials = materials.size();
    forEachPrimitive(document["meshes"],
                     [&](const JsonValue& primitive, const PrimitiveName& name) -> std::optional<Error>
                     {
                         checkPrimitive(primitive, name, counts, report);
                         return std::nullopt;
                     });
}

} // namespace osgGpuAnimation::gltf
