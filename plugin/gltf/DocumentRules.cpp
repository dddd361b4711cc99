// SPDX-License-Identifier: MIT
#include "gltf/DocumentRules.h"

#include "gltf/AnimationRules.h"
#include "gltf/ElementName.h"
#include "gltf/NodeRules.h"
#include "gltf/PrimitiveRules.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

const std::string_view supportedExtensions[] = {"KHR_mesh_quantization",   "KHR_texture_transform",
                                                "KHR_materials_unlit",     "KHR_materials_emissive_strength",
                                                "EXT_meshopt_compression", "KHR_draco_mesh_compression",
                                                "EXT_mesh_gpu_instancing"};

bool isSupported(std::string_view extension)
{
    return std::find(std::begin(supportedExtensions), std::end(supportedExtensions), extension) !=
           std::end(supportedExtensions);
}

/// "2.1" is 2 and 1; nothing for what is no version.
std::optional<std::pair<int, int>> parseVersion(std::string_view text)
{
    int major = 0, minor = 0;
    const char* const end = text.data() + text.size();
    const std::from_chars_result first = std::from_chars(text.data(), end, major);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') return std::nullopt;
    const std::from_chars_result second = std::from_chars(first.ptr + 1, end, minor);
    if (second.ec != std::errc() || second.ptr != end || major < 0 || minor < 0) return std::nullopt;
    return std::pair(major, minor);
}

std::optional<Error> checkVersion(const JsonValue& asset)
{
    const JsonValue version = asset["version"];
    const auto parsed = parseVersion(version.text());
    if (!parsed || parsed->first != 2) return fault("asset.version", "glTF 2.x", version.description());
    const JsonValue least = asset["minVersion"];
    if (!least) return std::nullopt;
    const auto parsedLeast = parseVersion(least.text());
    if (!parsedLeast || *parsedLeast > std::pair(2, 0))
        return fault("asset.minVersion", "a version that glTF 2.0 satisfies", least.description());
    return std::nullopt;
}

std::optional<Error> checkExtensions(const JsonValue& document, Report& report)
{
    std::size_t i = 0;
    for (const JsonValue& extension : document["extensionsRequired"])
    {
        if (!isSupported(extension.text()))
            return fault(elementName("extensionsRequired", i), "an extension that is supported",
                         extension.description());
        ++i;
    }
    i = 0;
    for (const JsonValue& extension : document["extensionsUsed"])
    {
        if (!isSupported(extension.text()))
            report.note(elementName("extensionsUsed", i) + ": " + extension.description() +
                        " is not supported and ignored");
        ++i;
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

std::optional<Error> checkCameras(const JsonValue& cameras)
{
    std::size_t i = 0;
    for (const JsonValue& camera : cameras)
    {
        const std::string_view type = camera["type"].text();
        if (!camera[type]) return fault(elementName("cameras", i) + '.' + std::string(type), "an object", "nothing");
        ++i;
    }
    return std::nullopt;
}

void noteScenes(const JsonValue& document, Report& report)
{
    if (!document["scenes"])
        report.note("scenes: the document has none: it is a library of parts");
    else if (!document["scene"])
        report.note("scene: the document names none to show");
}

} // namespace

std::optional<Error> checkDocumentRules(const JsonValue& document, Report& report)
{
    std::optional<Error> error = checkVersion(document["asset"]);
    if (!error) error = checkExtensions(document, report);
    if (!error) error = checkImages(document["images"]);
    if (!error) error = checkCameras(document["cameras"]);
    if (!error) error = checkPrimitiveRules(document["meshes"], report);
    if (!error) error = checkAnimationRules(document["animations"], report);
    if (error) return error;
    checkNodeRules(document["nodes"], report);
    noteScenes(document, report);
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
