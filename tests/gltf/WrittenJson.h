// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

namespace osgGpuAnimation::gltf
{

inline std::string quotedJson(std::string_view text)
{
    std::string out = "\"";
    for (const char each : text)
    {
        const auto byte = static_cast<unsigned char>(each);
        if (byte >= 0x20 && byte != '"' && byte != '\\')
            out += each;
        else
            out += std::string("\\u00") + "0123456789abcdef"[byte >> 4] + "0123456789abcdef"[byte & 15];
    }
    return out + '"';
}

inline std::string numberJson(double number)
{
    char text[32];
    const bool isInteger = std::trunc(number) == number && std::abs(number) <= 9007199254740992.0;
    const std::to_chars_result end = isInteger ? std::to_chars(text, text + sizeof(text), std::int64_t(number))
                                               : std::to_chars(text, text + sizeof(text), number);
    return std::string(text, end.ptr);
}

/// The text of a value and of all values below it that were not left out. Numbers without a fraction are written as
/// integers (8.0 as 8).
inline std::string writeJson(const JsonValue& value)
{
    const bool isObject = value.is(JsonTree::Type::Object);
    if (value.is(JsonTree::Type::Null)) return "null";
    if (value.is(JsonTree::Type::Boolean)) return value.boolean() ? "true" : "false";
    if (value.is(JsonTree::Type::Number)) return numberJson(value.number());
    if (value.is(JsonTree::Type::String)) return quotedJson(value.text());
    std::string out;
    for (const JsonValue& each : value)
        out += (out.empty() ? "" : ",") + (isObject ? quotedJson(each.key()) + ':' : "") + writeJson(each);
    return isObject ? '{' + out + '}' : '[' + out + ']';
}

} // namespace osgGpuAnimation::gltf
