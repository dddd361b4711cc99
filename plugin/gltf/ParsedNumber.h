// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// The number that the text is from its first character to its last, whatever the locale; nothing where it is none or
/// beyond what Number holds.
template <typename Number>
std::optional<Number> parsedNumber(std::string_view text)
{
    Number number = 0;
    const char* const end = text.data() + text.size();
    const std::from_chars_result read = std::from_chars(text.data(), end, number);
    return read.ec == std::errc() && read.ptr == end ? std::optional<Number>(number) : std::nullopt;
}

} // namespace osgGpuAnimation::gltf
