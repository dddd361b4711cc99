// SPDX-License-Identifier: MIT
#include "gltf/document/DocumentRules.h"

#include "gltf/document/AttributeSemantic.h"
#include "gltf/file/Elements.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

using Kind = AttributeSemantic::Kind;

const std::size_t maxDracoAttributes = 256; // Draco's own limit

bool isMorphable(Kind kind)
{
    return kind == Kind::Position || kind == Kind::Normal || kind == Kind::Tangent || kind == Kind::TexCoord ||
           kind == Kind::Color;
}

/// Does nothing if the object has no such member.
void leaveOut(const JsonValue& object, const JsonValue& member, const std::string& name, const std::string& why,
              Report& report)
{
    if (!member) return;
    report.warn(name + '.' + printable(member.key()) + ": " + why + "; left out");
    member.dropFrom(object);
}

/// The element loses its members and keeps its place.
void emptyElement(const JsonValue& element, const Error& why, Report& report)
{
    report.warn(why.message + "; the element is left out");
    element.dropMembers();
}

/// target: of a primitive; -1: its own attributes.
void leaveOutUnknown(const JsonValue& attributes, const PrimitiveName& name, int target, Report& report)
{
    for (const JsonValue& attribute : attributes)
    {
        const std::optional<AttributeSemantic> semantic = AttributeSemantic::parse(attribute.key());
        if (!semantic || (target >= 0 && !isMorphable(semantic->kind)))
            leaveOut(attributes, attribute, name.attributes(target), "no attribute that glTF knows", report);
    }
}

void leaveOutGaps(const JsonValue& attributes, const PrimitiveName& name, Report& report)
{
    std::array<std::bitset<AttributeSemantic::maxSets>, static_cast<std::size_t>(Kind::Custom) + 1> sets;
    for (const JsonValue& attribute : attributes)
    {
        const AttributeSemantic semantic = *AttributeSemantic::parse(attribute.key());
        sets[static_cast<std::size_t>(semantic.kind)].set(static_cast<std::size_t>(semantic.set));
    }
    for (const JsonValue& attribute : attributes)
    {
        const AttributeSemantic semantic = *AttributeSemantic::parse(attribute.key());
        if (semantic.kind == Kind::TexCoord) continue; // textures name their set
        for (int before = 0; before < semantic.set; ++before)
            if (!sets[static_cast<std::size_t>(semantic.kind)].test(static_cast<std::size_t>(before)))
            {
                leaveOut(attributes, attribute, name.attributes(), "the sets before it are missing", report);
                break;
            }
    }
}

/// Makes a primitive undrawable: no attributes, no indices, the same number of targets, all empty.
void emptyPrimitive(const JsonValue& primitive)
{
    primitive["attributes"].dropMembers();
    for (const JsonValue& target : primitive["targets"])
        target.dropMembers();
    for (const char* member : {"indices", "extensions"})
        if (const JsonValue value = primitive[member]) value.dropFrom(primitive);
}

void checkPrimitive(const JsonValue& primitive, const PrimitiveName& name, Report& report)
{
    const JsonValue attributes = primitive["attributes"];
    leaveOutUnknown(attributes, name, -1, report);
    leaveOutGaps(attributes, name, report);
    int target = 0;
    for (const JsonValue& targetAttributes : primitive["targets"])
        leaveOutUnknown(targetAttributes, name, target++, report);
    if (attributes["POSITION"]) return;
    report.warn(name.attributes() + ": expected POSITION, found none; the primitive is not drawn");
    emptyPrimitive(primitive);
}

std::optional<Error> checkDraco(const JsonValue& primitive, const PrimitiveName& name)
{
    const JsonValue attributes = primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"];
    if (!attributes) return std::nullopt;
    const std::string place = name.text() + ".extensions.KHR_draco_mesh_compression.attributes";
    if (!attributes.is(JsonTree::Type::Object)) return fault(place, "an object", attributes.description());
    if (attributes.size() > maxDracoAttributes)
        return fault(place, "at most " + std::to_string(maxDracoAttributes) + " attributes", attributes.size());
    for (const JsonValue& attribute : attributes)
    {
        if (!attribute.isInteger() || attribute.number() < 0.0 || attribute.number() > 4294967295.0)
            return fault(place + '.' + printable(attribute.key()), "an attribute's number", attribute.description());
        if (!primitive["attributes"][attribute.key()])
            return fault(place + '.' + printable(attribute.key()), "an attribute of the primitive", "another");
    }
    return std::nullopt;
}

/// A mapping with a variant that occurs before in the primitive loses its members, and takes none of its variants
/// (KHR_materials_variants).
void checkMappings(const JsonValue& mappings, const std::string& name, Report& report)
{
    std::unordered_set<double> taken;
    std::size_t i = 0;
    for (const JsonValue& mapping : mappings)
    {
        const std::string place = elementName(name, i++) + ".variants";
        std::unordered_set<double> own;
        for (const JsonValue& variant : mapping["variants"])
        {
            if (taken.count(variant.number()) == 0 && own.insert(variant.number()).second) continue;
            emptyElement(mapping, fault(place, "each variant once", variant.description() + " again"), report);
            own.clear();
            break;
        }
        taken.merge(own);
    }
}

/// Primitives (glTF 2.0, section 3.7.2): attributes that glTF does not know, and sets that do not follow set 0, are
/// left out; a primitive without POSITION loses all its attributes and keeps its place; all primitives of a mesh have
/// the same number of morph targets.
std::optional<Error> checkPrimitiveRules(const JsonValue& meshes, Report& report)
{
    std::size_t m = 0;
    for (const JsonValue& mesh : meshes)
    {
        std::size_t p = 0;
        std::size_t targets = 0;
        for (const JsonValue& primitive : mesh["primitives"])
        {
            const PrimitiveName name{m, p};
            const JsonValue list = primitive["targets"];
            const std::size_t count = list ? list.size() : 0;
            if (p == 0) targets = count;
            if (count != targets)
                return fault(name.text() + ".targets", std::to_string(targets) + " as in the primitives before", count);
            if (std::optional<Error> error = checkDraco(primitive, name)) return error;
            checkPrimitive(primitive, name, report);
            if (const JsonValue variants = primitive["extensions"]["KHR_materials_variants"])
                checkMappings(variants["mappings"], name.text() + ".extensions.KHR_materials_variants.mappings",
                              report);
            ++p;
        }
        const JsonValue weights = mesh["weights"];
        if (weights && weights.size() != targets)
            return fault(elementName("meshes", m) + ".weights", std::to_string(targets) + " (one a morph target)",
                         weights.size());
        ++m;
    }
    return std::nullopt;
}

const std::string_view paths[] = {"translation", "rotation", "scale", "weights"};

/// One number for each property of each node.
using Properties = std::unordered_set<std::uint64_t>;

void checkTarget(const JsonValue& channel, std::size_t animation, std::size_t index, Properties& animated,
                 Report& report)
{
    const JsonValue target = channel["target"];
    if (!target) return;
    const JsonValue node = target["node"], path = target["path"];
    const bool hasPointer(target["extensions"]["KHR_animation_pointer"]["pointer"]);
    if (path && path.text() == "pointer" && hasPointer) return; // resolvePointers() checks it
    if (!node || !path) return target.dropFrom(channel);        // allowed: an extension may define the target
    const auto known = std::find(std::begin(paths), std::end(paths), path.text());
    const auto name = [&] { return elementName("animations", animation, "channels", index) + ".target"; };
    if (known == std::end(paths))
    {
        report.warn(name() + ".path: expected translation, rotation, scale or weights, found " + path.description() +
                    "; channel ignored");
        return target.dropFrom(channel);
    }
    const std::uint64_t property =
        static_cast<std::uint64_t>(node.number()) * std::size(paths) + static_cast<std::uint64_t>(known - paths);
    if (animated.insert(property).second) return;
    report.warn(name() + ": another channel animates " + std::string(path.text()) + " of the node; channel ignored");
    target.dropFrom(channel);
}

/// Channels (glTF 2.0, section 3.11): the sampler is one of the animation's, the path is known, no property of a node
/// is animated twice. A channel that animates nothing loses its target and keeps its place.
std::optional<Error> checkAnimationRules(const JsonValue& animations, Report& report)
{
    std::size_t i = 0;
    for (const JsonValue& animation : animations)
    {
        const JsonValue list = animation["samplers"];
        const std::size_t samplers = list ? list.size() : 0;
        Properties animated;
        std::size_t c = 0;
        for (const JsonValue& channel : animation["channels"])
        {
            const JsonValue sampler = channel["sampler"];
            if (sampler.number() >= static_cast<double>(samplers))
                return fault(elementName("animations", i, "channels", c) + ".sampler",
                             "an index below " + std::to_string(samplers) + " of the animation's samplers",
                             sampler.description());
            checkTarget(channel, i, c, animated, report);
            ++c;
        }
        ++i;
    }
    return std::nullopt;
}

// More than the rounding to a few digits; the Khronos validator has the same limit.
const double unitTolerance = 0.00769;

void checkMatrix(const JsonValue& matrix, const std::string& name, Report& report)
{
    static const double lastRow[] = {0.0, 0.0, 0.0, 1.0};
    bool mended = false;
    std::size_t i = 0;
    for (const JsonValue& element : matrix)
    {
        if (i % 4 == 3 && element.number() != lastRow[i / 4])
        {
            element.setNumber(lastRow[i / 4]);
            mended = true;
        }
        ++i;
    }
    if (mended) report.warn(name + ".matrix: its last row is not 0 0 0 1; taken as such");
}

void checkRotation(const JsonValue& node, const std::string& name, Report& report)
{
    const JsonValue rotation = node["rotation"];
    double squares = 0.0;
    for (const JsonValue& element : rotation)
        squares += element.number() * element.number();
    const double length = std::sqrt(squares);
    if (std::abs(length - 1.0) <= unitTolerance) return;
    if (length < 1e-12 || !std::isfinite(length))
        return leaveOut(node, rotation, name, "expected a unit quaternion, found one without direction", report);
    for (const JsonValue& element : rotation)
        element.setNumber(element.number() / length);
    report.warn(name + ".rotation: expected a unit quaternion, found one of length " + numberText(length) +
                "; made unit");
}

/// Mends nodes with a warning each (glTF 2.0, sections 3.5.2, 3.5.3): a matrix beside translation, rotation or scale
/// (the matrix is used), rotations that are not unit quaternions, skins and weights without a mesh.
void checkNodeRules(const JsonValue& nodes, Report& report)
{
    std::size_t i = 0;
    for (const JsonValue& node : nodes)
    {
        const std::string name = elementName("nodes", i++);
        if (const JsonValue matrix = node["matrix"])
        {
            for (const std::string_view member : {"translation", "rotation", "scale"})
                leaveOut(node, node[member], name, "the node has a matrix, which counts", report);
            checkMatrix(matrix, name, report);
        }
        if (node["rotation"]) checkRotation(node, name, report);
        if (!node["mesh"])
            for (const std::string_view member : {"skin", "weights"})
                leaveOut(node, node[member], name, "the node has no mesh", report);
    }
}

/// A camera without the view of its type (glTF 2.0, section 3.10) loses its members and keeps its place.
void checkCameras(const JsonValue& cameras, Report& report)
{
    std::size_t i = 0;
    for (const JsonValue& camera : cameras)
    {
        const std::string name = elementName("cameras", i++);
        const JsonValue type = camera["type"];
        if (!type) continue;
        const JsonValue view = camera[type.text()], height = view["ymag"];
        if (view && !(height && height.number() == 0.0)) continue;
        emptyElement(camera, fault(name + '.' + std::string(type.text()), "the size of the view", height.description()),
                     report);
    }
}

/// Spots without their cone lose their members and keep their place (KHR_lights_punctual).
void checkLights(const JsonValue& lights, Report& report)
{
    constexpr double defaultOuterAngle = 0.7853981633974483; // pi / 4
    std::size_t i = 0;
    for (const JsonValue& light : lights)
    {
        const std::string name = elementName("extensions.KHR_lights_punctual.lights", i++) + ".spot";
        const JsonValue type = light["type"], spot = light["spot"];
        const JsonValue inner = spot["innerConeAngle"], outer = spot["outerConeAngle"];
        if (type && type.text() == "spot" && !spot)
            emptyElement(light, fault(name, "an object", "nothing"), report);
        else if (inner && inner.number() >= (outer ? outer.number() : defaultOuterAngle))
            leaveOut(spot, inner, name, "expected an angle below outerConeAngle, found " + inner.description(), report);
    }
}

const std::string_view supportedExtensions[] = {"KHR_mesh_quantization",      "KHR_texture_transform",
                                                "KHR_materials_unlit",        "KHR_materials_emissive_strength",
                                                "KHR_materials_ior",          "KHR_materials_specular",
                                                "KHR_materials_clearcoat",    "KHR_materials_sheen",
                                                "KHR_materials_transmission", "KHR_materials_pbrSpecularGlossiness",
                                                "EXT_meshopt_compression",    "KHR_draco_mesh_compression",
                                                "EXT_mesh_gpu_instancing",    "KHR_lights_punctual",
                                                "EXT_texture_webp",           "KHR_materials_variants",
                                                "KHR_animation_pointer",      "KHR_node_visibility",
                                                "KHR_meshopt_compression",    "MSFT_lod"};

/// Parts of the names of extensions that change looks alone, or nothing that is drawn: a file that requires them is
/// shown without them.
const std::string_view looksAloneNames[] = {
    "_materials_", "_texture_", "_lights_", "KHR_environment_map", "MSFT_packing_", "KHR_techniques_webgl", "KHR_xmp",
};

bool changesLooksAlone(std::string_view extension)
{
    return std::any_of(std::begin(looksAloneNames), std::end(looksAloneNames),
                       [&](std::string_view part) { return extension.find(part) != std::string_view::npos; });
}

/// "2.1" is 2 and 1; nothing if the text is not a version.
std::optional<std::pair<unsigned, unsigned>> parseVersion(std::string_view text)
{
    const std::size_t dot = std::min(text.find('.'), text.size());
    const auto major = parsedNumber<unsigned>(text.substr(0, dot));
    const auto minor = parsedNumber<unsigned>(text.substr(std::min(dot + 1, text.size())));
    if (!major || !minor) return std::nullopt;
    return std::pair(*major, *minor);
}

std::optional<Error> checkVersion(const JsonValue& asset)
{
    const JsonValue version = asset["version"];
    const auto parsed = parseVersion(version.text());
    if (!parsed || parsed->first != 2) return fault("asset.version", "glTF 2.x", version.description());
    const JsonValue min = asset["minVersion"];
    if (!min) return std::nullopt;
    const auto parsedLeast = parseVersion(min.text());
    if (!parsedLeast || *parsedLeast > std::pair(2u, 0u))
        return fault("asset.minVersion", "a version that glTF 2.0 satisfies", min.description());
    return std::nullopt;
}

/// One warning for each extension that changes looks alone, one note for each other that is not required.
std::optional<Error> checkExtensions(const JsonValue& document, Report& report)
{
    std::unordered_set<std::string_view> seen;
    for (const char* const list : {"extensionsRequired", "extensionsUsed"})
    {
        std::size_t i = 0;
        for (const JsonValue& extension : document[list])
        {
            const std::string name = elementName(list, i++);
            if (contains(supportedExtensions, extension.text()) || !seen.insert(extension.text()).second) continue;
            if (changesLooksAlone(extension.text()))
                report.warn(name + ": " + extension.description() +
                            " is not supported and changes looks alone; left out");
            else if (list == std::string_view("extensionsRequired"))
                return fault(name, "an extension that is supported", extension.description());
            else
                report.note(name + ": " + extension.description() + " is not supported and ignored");
        }
    }
    return std::nullopt;
}

std::optional<Error> checkImages(const JsonValue& images)
{
    std::size_t i = 0;
    for (const JsonValue& image : images)
    {
        const bool uri(image["uri"]), bufferView(image["bufferView"]);
        if (uri == bufferView)
            return fault(elementName("images", i), "either uri or bufferView", uri ? "both" : "neither");
        ++i;
    }
    return std::nullopt;
}

} // namespace

std::optional<Error> checkDocumentRules(const JsonValue& document, Report& report)
{
    std::optional<Error> error = checkVersion(document["asset"]);
    if (!error) error = checkExtensions(document, report);
    if (!error) error = checkImages(document["images"]);
    if (!error) error = checkPrimitiveRules(document["meshes"], report);
    if (!error) error = checkAnimationRules(document["animations"], report);
    if (error) return error;
    checkNodeRules(document["nodes"], report);
    checkCameras(document["cameras"], report);
    checkLights(document["extensions"]["KHR_lights_punctual"]["lights"], report);
    if (!document["scenes"])
        report.note("scenes: the document has none: it is a library of parts");
    else if (!document["scene"])
        report.note("scene: the document names none to show");
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
