// SPDX-License-Identifier: MIT
#include "gltf/export/GlbWriter.h"

#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Elements.h"
#include "gltf/file/ImportOptions.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr int arrayBuffer = 34962, elementArrayBuffer = 34963;           // bufferView.target
constexpr int unsignedShort = 5123, unsignedInt = 5125, floating = 5126; // accessor.componentType

std::size_t componentsOf(const char* type)
{
    return std::strcmp(type, "SCALAR") == 0 ? 1
           : std::strcmp(type, "MAT4") == 0 ? 16
                                            : static_cast<std::size_t>(type[3] - '0');
}

template <typename T>
std::string_view bytesOf(const std::vector<T>& values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

void appendNumber(std::string& to, std::uint32_t number)
{
    for (int shift = 0; shift < 32; shift += 8)
        to += static_cast<char>(number >> shift & 0xff);
}

/// Mends the document, and counts what the import counts.
struct DocumentCheck
{
    Report& report;
    std::size_t bytes = 0; ///< see ImportOptions::maxDocumentBytes
    std::string place{};   ///< of the current value, for messages

    void visit(nlohmann::json& value)
    {
        bytes += bytesOfJsonValue;
        if (value.is_string()) bytes += value.get_ref<const std::string&>().size() * bytesOfJsonLetter;
        if (value.is_number_float() && !std::isfinite(value.get<double>()))
        {
            report.warn(place + ": it is not finite; written as 0");
            value = 0.0;
        }
        if (!value.is_structured()) return;
        const std::size_t outer = place.size();
        std::size_t index = 0;
        for (auto& [key, inner] : value.items())
        {
            if (value.is_array())
                place += elementName("", index++);
            else
            {
                bytes += key.size() * bytesOfJsonLetter;
                place += (outer == 0 ? "" : ".") + printable(key);
            }
            visit(inner);
            place.resize(outer);
        }
    }
};

} // namespace

std::size_t append(nlohmann::json& array, nlohmann::json element)
{
    array.push_back(std::move(element));
    return array.size() - 1;
}

GlbWriter::GlbWriter()
{
    document["asset"] = {{"version", "2.0"}, {"generator", "osgGpuAnimation"}};
}

std::size_t GlbWriter::addBytes(std::string_view bytes, int target)
{
    _binary.resize((_binary.size() + 3) / 4 * 4);
    nlohmann::json view{{"buffer", 0}, {"byteOffset", _binary.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    _binary += bytes;
    return append(document["bufferViews"], std::move(view));
}

std::size_t GlbWriter::addAccessor(std::size_t view, int componentType, std::size_t count, const char* type)
{
    return append(document["accessors"],
                  {{"bufferView", view}, {"componentType", componentType}, {"count", count}, {"type", type}});
}

std::size_t GlbWriter::addFloats(const std::vector<float>& values, const char* type, Use use)
{
    if (use == Use::Times)
        if (const auto known = _times.find(values); known != _times.end()) return known->second;
    const std::size_t components = componentsOf(type);
    const std::size_t accessor = addAccessor(addBytes(bytesOf(values), use == Use::Vertices ? arrayBuffer : 0),
                                             floating, values.size() / components, type);
    if (use == Use::Times) _times.emplace(values, accessor);
    if (use == Use::Values) return accessor;
    std::vector<float> min(components, std::numeric_limits<float>::max());
    std::vector<float> max(components, std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        min[i % components] = std::min(min[i % components], values[i]);
        max[i % components] = std::max(max[i % components], values[i]);
    }
    document["accessors"][accessor]["min"] = min;
    document["accessors"][accessor]["max"] = max;
    return accessor;
}

std::size_t GlbWriter::addIndices(const std::vector<std::uint32_t>& indices)
{
    return addAccessor(addBytes(bytesOf(indices), elementArrayBuffer), unsignedInt, indices.size(), "SCALAR");
}

std::size_t GlbWriter::addJoints(const std::vector<std::uint16_t>& joints)
{
    return addAccessor(addBytes(bytesOf(joints), arrayBuffer), unsignedShort, joints.size() / 4, "VEC4");
}

void GlbWriter::useExtension(const std::string& name)
{
    nlohmann::json& used = document["extensionsUsed"];
    if (!contains(used, name)) used.push_back(name);
}

Result<std::string> GlbWriter::glb(Report& report) const
{
    const Error tooLarge{"the scene is too large for a GLB"};
    if (isFull()) return tooLarge;
    constexpr std::uint32_t version = 2, jsonChunk = 0x4e4f534a, binaryChunk = 0x004e4942; // "JSON", "BIN\0"
    std::string binary = _binary;
    binary.resize((binary.size() + 3) / 4 * 4);
    nlohmann::json whole = document;
    if (!binary.empty())
        whole["buffers"] = nlohmann::json::array({nlohmann::json::object({{"byteLength", binary.size()}})});
    DocumentCheck check{report};
    check.visit(whole);
    if (check.bytes > ImportOptions().maxDocumentBytes)
        return Error{"the scene has more nodes, meshes, materials and names than the import reads"};
    // Names of a file may be no UTF-8.
    std::string text = whole.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t chunks = 12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
    if (chunks > maxBytes) return tooLarge;
    std::string bytes = "glTF";
    bytes.reserve(chunks);
    appendNumber(bytes, version);
    appendNumber(bytes, static_cast<std::uint32_t>(chunks));
    appendNumber(bytes, static_cast<std::uint32_t>(text.size()));
    appendNumber(bytes, jsonChunk);
    bytes += text;
    if (binary.empty()) return bytes;
    appendNumber(bytes, static_cast<std::uint32_t>(binary.size()));
    appendNumber(bytes, binaryChunk);
    return bytes += binary;
}

} // namespace osgGpuAnimation::gltf
