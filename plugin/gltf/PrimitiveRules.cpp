// SPDX-License-Identifier: MIT
#include "gltf/PrimitiveRules.h"

#include "gltf/data/AttributeSemantic.h"
#include "gltf/ElementName.h"

#include <array>
#include <bitset>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

using Kind = AttributeSemantic::Kind;

const std::size_t mostDracoAttributes = 256; // Draco's own limit

bool isMorphable(Kind kind)
{
    return kind == Kind::Position || kind == Kind::Normal || kind == Kind::Tangent || kind == Kind::TexCoord ||
           kind == Kind::Color;
}

void leaveOut(const JsonValue& attributes, const JsonValue& attribute, const std::string& name, const char* why,
              Report& report)
{
    report.warn(name + '.' + printable(attribute.key()) + ": " + why + "; left out");
    attribute.dropFrom(attributes);
}

void leaveOutUnknown(const JsonValue& attributes, const std::string& name, bool morph, Report& report)
{
    for (const JsonValue& attribute : attributes)
    {
        const std::optional<AttributeSemantic> semantic = AttributeSemantic::parse(attribute.key());
        if (!semantic || (morph && !isMorphable(semantic->kind)))
            leaveOut(attributes, attribute, name, "no attribute that glTF knows", report);
    }
}

void leaveOutGaps(const JsonValue& attributes, const std::string& name, Report& report)
{
    std::array<std::bitset<AttributeSemantic::mostSets>, std::size_t(Kind::Custom) + 1> sets;
    for (const JsonValue& attribute : attributes)
    {
        const AttributeSemantic semantic = *AttributeSemantic::parse(attribute.key());
        sets[std::size_t(semantic.kind)].set(std::size_t(semantic.set));
    }
    for (const JsonValue& attribute : attributes)
    {
        const AttributeSemantic semantic = *AttributeSemantic::parse(attribute.key());
        if (semantic.kind == Kind::TexCoord) continue; // each is read for itself, by the texture that names it
        for (int before = 0; before < semantic.set; ++before)
            if (!sets[std::size_t(semantic.kind)].test(std::size_t(before)))
            {
                leaveOut(attributes, attribute, name, "the sets before it are missing", report);
                break;
            }
    }
}

void dropAll(const JsonValue& members)
{
    for (const JsonValue& member : members)
        member.dropFrom(members);
}

/// A primitive that cannot be drawn: no attributes, no indices, as many targets as before and nothing in them.
void empty(const JsonValue& primitive)
{
    dropAll(primitive["attributes"]);
    for (const JsonValue& target : primitive["targets"])
        dropAll(target);
    for (const char* member : {"indices", "extensions"})
        if (const JsonValue value = primitive[member]) value.dropFrom(primitive);
}

void checkPrimitive(const JsonValue& primitive, const std::string& name, Report& report)
{
    const JsonValue attributes = primitive["attributes"];
    leaveOutUnknown(attributes, name + ".attributes", false, report);
    leaveOutGaps(attributes, name + ".attributes", report);
    std::size_t target = 0;
    for (const JsonValue& targetAttributes : primitive["targets"])
        leaveOutUnknown(targetAttributes, name + '.' + elementName("targets", target++), true, report);
    if (attributes["POSITION"]) return;
    report.warn(name + ".attributes: expected POSITION, found none; the primitive is not drawn");
    empty(primitive);
}

std::optional<Error> checkDraco(const JsonValue& primitive, const std::string& name)
{
    const JsonValue attributes = primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"];
    if (!attributes) return std::nullopt;
    const std::string place = name + ".extensions.KHR_draco_mesh_compression.attributes";
    if (!attributes.is(JsonTree::Type::Object)) return fault(place, "an object", attributes.description());
    if (attributes.size() > mostDracoAttributes)
        return fault(place, "at most " + std::to_string(mostDracoAttributes) + " attributes",
                     std::to_string(attributes.size()));
    for (const JsonValue& attribute : attributes)
    {
        if (!attribute.isInteger() || attribute.number() < 0.0 || attribute.number() > 4294967295.0)
            return fault(place + '.' + printable(attribute.key()), "an attribute's number", attribute.description());
        if (!primitive["attributes"][attribute.key()])
            return fault(place + '.' + printable(attribute.key()), "an attribute of the primitive", "another");
    }
    return std::nullopt;
}

} // namespace

std::optional<Error> checkPrimitiveRules(const JsonValue& meshes, Report& report)
{
    std::size_t m = 0;
    for (const JsonValue& mesh : meshes)
    {
        std::size_t p = 0;
        std::size_t targets = 0;
        for (const JsonValue& primitive : mesh["primitives"])
        {
            const std::string name = elementName("meshes", m, "primitives", p);
            const JsonValue list = primitive["targets"];
            const std::size_t count = list ? list.size() : 0;
            if (p == 0) targets = count;
            if (count != targets)
                return fault(name + ".targets", std::to_string(targets) + " as in the primitives before",
                             std::to_string(count));
            if (std::optional<Error> error = checkDraco(primitive, name)) return error;
            checkPrimitive(primitive, name, report);
            ++p;
        }
        const JsonValue weights = mesh["weights"];
        if (weights && weights.size() != targets)
            return fault(elementName("meshes", m) + ".weights", std::to_string(targets) + " (one a morph target)",
                         std::to_string(weights.size()));
        ++m;
    }
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
