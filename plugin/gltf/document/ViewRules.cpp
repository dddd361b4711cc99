// SPDX-License-Identifier: MIT
#include "gltf/document/DocumentRules.h"

#include <optional>
#include <string>
#include <string_view>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::string_view lightExtension = "KHR_lights_punctual";
constexpr double maxFloat = 3.4028234663852886e38;
constexpr double halfPi = 1.5707964; // pi / 2 as a float, rounded up
constexpr double pi = 3.14159265358979;

struct NumberRule
{
    std::string_view member;
    double min, max;
    bool isLeastAllowed;
    const char* expected;
};

constexpr NumberRule lightNumbers[] = {
    {"intensity", 0.0, maxFloat, true, "a number from 0"},
    {"range", 0.0, maxFloat, false, "a number above 0"},
};

constexpr NumberRule coneNumbers[] = {
    {"innerConeAngle", 0.0, halfPi, true, "an angle from 0, below pi / 2"},
    {"outerConeAngle", 0.0, halfPi, false, "an angle above 0, at most pi / 2"},
};

constexpr double defaultOuterAngle = 0.7853981633974483; // pi / 4

using Fault = std::optional<Error>;

bool isIn(const NumberRule& rule, double number)
{
    return number <= rule.max && (number > rule.min || (rule.isLeastAllowed && number == rule.min));
}

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
        if (isIn(rule, value.number())) continue;
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
    if (!spot || !spot.is(JsonTree::Type::Object)) return fault(name + ".spot", "an object", spot.description());
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
    const std::string_view text = type && type.is(JsonTree::Type::String) ? type.text() : "";
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
    const JsonValue extension = extensions[lightExtension], lights = extension["lights"];
    const std::string name = "extensions.KHR_lights_punctual.lights";
    if (!extension) return 0;
    if (!lights || !lights.is(JsonTree::Type::Array))
    {
        report.warn(fault(name, "an array", lights.description()).message + "; no light is read");
        extension.dropFrom(extensions);
        return 0;
    }
    std::size_t index = 0;
    for (const JsonValue& light : lights)
    {
        const Fault wrong = checkLight(light, elementName(name, index++), report);
        if (!wrong) continue;
        report.warn(wrong->message + "; the light is left out");
        light.dropMembers();
    }
    return lights.size();
}

void checkNodeLight(const JsonValue& node, std::size_t index, std::size_t lights, Report& report)
{
    const JsonValue extensions = node["extensions"], extension = extensions[lightExtension];
    if (!extension) return;
    const JsonValue light = extension["light"];
    for (const JsonValue& member : extension)
        if (member.key() != "light") member.dropFrom(extension);
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

} // namespace

void checkViewRules(const JsonValue& document, Report& report)
{
    const std::size_t lights = checkLights(document["extensions"], report);
    std::size_t index = 0;
    for (const JsonValue& node : document["nodes"])
        checkNodeLight(node, index++, lights, report);
    index = 0;
    for (const JsonValue& camera : document["cameras"])
    {
        const Fault wrong = checkCamera(camera, elementName("cameras", index++));
        if (!wrong) continue;
        report.warn(wrong->message + "; the camera is left out");
        camera.dropMembers();
    }
}

} // namespace osgGpuAnimation::gltf
