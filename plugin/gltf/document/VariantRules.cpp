// SPDX-License-Identifier: MIT
#include "gltf/document/DocumentRules.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::string_view variantExtension = "KHR_materials_variants";

using Fault = std::optional<Error>;

void dropAllBut(const JsonValue& object, std::string_view first, std::string_view second = {})
{
    for (const JsonValue& member : object)
        if (member.key() != first && member.key() != second) member.dropFrom(object);
}

/// Returns how many places the list has.
std::size_t checkVariants(const JsonValue& extensions, Report& report)
{
    const JsonValue extension = extensions[variantExtension];
    const JsonValue variants = extension.is(JsonTree::Type::Object) ? extension["variants"] : JsonValue();
    const std::string name = "extensions.KHR_materials_variants.variants";
    if (!extension) return 0;
    if (!variants.is(JsonTree::Type::Array))
    {
        report.warn(fault(name, "an array", variants.description()).message + "; no variant is read");
        extension.dropFrom(extensions);
        return 0;
    }
    dropAllBut(extension, "variants");
    std::size_t index = 0;
    for (const JsonValue& variant : variants)
    {
        const std::string place = elementName(name, index++);
        const JsonValue text = variant.is(JsonTree::Type::Object) ? variant["name"] : JsonValue();
        if (text.is(JsonTree::Type::String))
        {
            dropAllBut(variant, "name");
            continue;
        }
        report.warn(fault(place + ".name", "a text", text.description()).message + "; the variant gets another name");
        variant.dropMembers();
    }
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
    const JsonValue mappings = extension.is(JsonTree::Type::Object) ? extension["mappings"] : JsonValue();
    const std::string place = name.text() + ".extensions.KHR_materials_variants.mappings";
    if (counts.variants == 0 || !mappings.is(JsonTree::Type::Array))
    {
        // Without the file's variants, one warning has named that.
        if (counts.variants > 0) report.warn(fault(place, "an array", mappings.description()).message + "; left out");
        return extension.dropFrom(extensions);
    }
    dropAllBut(extension, "mappings");
    std::unordered_set<std::size_t> taken;
    std::size_t index = 0;
    for (const JsonValue& mapping : mappings)
    {
        const Fault wrong = checkMapping(mapping, elementName(place, index++), counts, taken);
        if (!wrong)
        {
            dropAllBut(mapping, "material", "variants");
            continue;
        }
        report.warn(wrong->message + "; the mapping is left out");
        mapping.dropMembers();
    }
}

} // namespace

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
