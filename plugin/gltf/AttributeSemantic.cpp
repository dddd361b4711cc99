// SPDX-License-Identifier: MIT
#include "gltf/AttributeSemantic.h"

#include "gltf/ParsedNumber.h"

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
    return set && *set >= 0 && *set < AttributeSemantic::mostSets ? set : std::nullopt;
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

} // namespace osgGpuAnimation::gltf
