// SPDX-License-Identifier: MIT
#include "gltf/document/AttributeSemantic.h"

#include "gltf/file/Report.h"

#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

using Kind = AttributeSemantic::Kind;

/// 0 to 31 without leading zeros; else nothing.
std::optional<int> parseSet(std::string_view digits)
{
    if (digits.empty() || digits.size() > 2 || (digits.size() == 2 && digits[0] == '0')) return std::nullopt;
    const std::optional<int> set = parsedNumber<int>(digits);
    return set && *set >= 0 && *set < AttributeSemantic::maxSets ? set : std::nullopt;
}

/// Component types as bits; the normalized integers have their own.
enum Component : unsigned
{
    Float = 1,
    Byte = 2,
    ByteN = 4,
    UByte = 8,
    UByteN = 16,
    Short = 32,
    ShortN = 64,
    UShort = 128,
    UShortN = 256,
    UInt = 512,
    UIntN = 1024
};

enum Shape : unsigned
{
    Vec2 = 1,
    Vec3 = 2,
    Vec4 = 4
};

struct Format
{
    unsigned shapes; ///< 0: any
    unsigned components;
    unsigned quantized; ///< additional components with KHR_mesh_quantization
};

constexpr unsigned unsignedNormalized = UByteN | UShortN;
constexpr unsigned signedNormalized = ByteN | ShortN;
constexpr unsigned smallIntegers = Byte | UByte | Short | UShort;

/// By kind: of the primitive's own attributes, and of those of morph targets.
constexpr Format formats[][2] = {
    {{Vec3, Float, smallIntegers | signedNormalized | unsignedNormalized},
     {Vec3, Float, Byte | Short | signedNormalized}},                   // Position
    {{Vec3, Float, signedNormalized}, {Vec3, Float, signedNormalized}}, // Normal
    {{Vec4, Float, signedNormalized}, {Vec3, Float, signedNormalized}}, // Tangent
    {{Vec2, Float | unsignedNormalized, smallIntegers | signedNormalized},
     {Vec2, Float | signedNormalized | unsignedNormalized, Byte | Short}}, // TexCoord
    {{Vec3 | Vec4, Float | unsignedNormalized, 0},
     {Vec3 | Vec4, Float | signedNormalized | unsignedNormalized, 0}}, // Color
    {{Vec4, UByte | UShort | unsignedNormalized, 0}, {0, 0, 0}},       // Joints, integers even if normalized
    {{Vec4, Float | unsignedNormalized, 0}, {0, 0, 0}},                // Weights
    {{0, 0, 0}, {0, 0, 0}},                                            // Custom
};

unsigned shapeOf(const tinygltf::Accessor& accessor)
{
    const bool isVector = accessor.type >= TINYGLTF_TYPE_VEC2 && accessor.type <= TINYGLTF_TYPE_VEC4;
    return isVector ? Vec2 << (accessor.type - TINYGLTF_TYPE_VEC2) : 0;
}

unsigned componentOf(const tinygltf::Accessor& accessor)
{
    constexpr unsigned components[] = {Byte, UByte, Short, UShort, Float, UInt, Float}; // Float in place of GL_INT
    const unsigned component = components[accessor.componentType - TINYGLTF_COMPONENT_TYPE_BYTE];
    return accessor.normalized && component != Float ? 2 * component : component;
}

const char* const shapeNames[] = {"VEC2", "VEC3", "VEC4"};
const char* const componentNames[] = {"float",
                                      "byte",
                                      "normalized byte",
                                      "unsigned byte",
                                      "normalized unsigned byte",
                                      "short",
                                      "normalized short",
                                      "unsigned short",
                                      "normalized unsigned short",
                                      "unsigned int",
                                      "normalized unsigned int"};

/// The names of the bits that are set: `VEC3 or VEC4`.
template <unsigned count>
std::string namesOfBits(unsigned bits, const char* const (&names)[count])
{
    std::string text;
    for (unsigned bit = 0; bit < count; ++bit)
        if (bits >> bit & 1) text += (text.empty() ? "" : " or ") + std::string(names[bit]);
    return text;
}

} // namespace

std::optional<AttributeSemantic> AttributeSemantic::parse(std::string_view name)
{
    if (name == "POSITION") return AttributeSemantic{Kind::Position, 0};
    if (name == "NORMAL") return AttributeSemantic{Kind::Normal, 0};
    if (name == "TANGENT") return AttributeSemantic{Kind::Tangent, 0};
    if (!name.empty() && name[0] == '_') return AttributeSemantic{Kind::Custom, 0};
    static const std::pair<std::string_view, Kind> prefixes[] = {
        {"TEXCOORD_", Kind::TexCoord}, {"COLOR_", Kind::Color}, {"JOINTS_", Kind::Joints}, {"WEIGHTS_", Kind::Weights}};
    for (const auto& [prefix, kind] : prefixes)
    {
        if (name.substr(0, prefix.size()) != prefix) continue;
        if (const std::optional<int> set = parseSet(name.substr(prefix.size()))) return AttributeSemantic{kind, *set};
    }
    return std::nullopt;
}

std::string wrongAttributeFormat(const tinygltf::Accessor& accessor, Kind kind, AttributePlace place)
{
    const Format& format = formats[static_cast<std::size_t>(kind)][place.isMorphTarget ? 1 : 0];
    if (format.shapes == 0) return {};
    const unsigned components = format.components | (place.isQuantized ? format.quantized : 0);
    if ((shapeOf(accessor) & format.shapes) && (componentOf(accessor) & components)) return {};
    return namesOfBits(format.shapes, shapeNames) + " of " + namesOfBits(components, componentNames);
}

std::string formatText(const tinygltf::Accessor& accessor)
{
    const std::string shape = namesOfBits(shapeOf(accessor), shapeNames);
    const char* const other = accessor.type == TINYGLTF_TYPE_SCALAR ? "SCALAR" : "MAT";
    return (shape.empty() ? other : shape) + " of " + namesOfBits(componentOf(accessor), componentNames);
}

} // namespace osgGpuAnimation::gltf
