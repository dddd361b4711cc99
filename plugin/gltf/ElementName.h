// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace osgGpuAnimation::gltf
{

// How messages name the parts of a document: accessors[3].byteOffset, animations[2].channels[4].target.path.

inline std::string elementName(std::string_view collection, std::size_t index)
{
    return std::string(collection) + '[' + std::to_string(index) + ']';
}

/// elementName("animations", 2, "channels", 4) is animations[2].channels[4].
template <typename... Rest>
std::string elementName(std::string_view collection, std::size_t index, std::string_view inner, const Rest&... rest)
{
    std::string name = elementName(collection, index) + '.';
    if constexpr (sizeof...(Rest) == 0)
        name += inner;
    else
        name += elementName(inner, rest...);
    return name;
}

/// Text of the file made fit for a message: in quotation marks, clipped, nothing but printable ASCII.
std::string quoted(std::string_view text);
inline std::string quoted(const std::string& text)
{
    return quoted(std::string_view(text));
} // not std::quoted
/// The same without the quotation marks.
std::string printable(std::string_view text, std::size_t most = 80);
/// 8, 0.5, 1e+30: as short as it can be.
std::string numberText(double number);

/// `element: expected …, found …`
Error fault(std::string_view element, std::string_view expected, std::string_view found);

} // namespace osgGpuAnimation::gltf
