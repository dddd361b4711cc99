// SPDX-License-Identifier: MIT
#include "plugin/WrittenJson.h"

#include <charconv>
#include <cmath>
#include <cstdint>

namespace osgGpuAnimation::gltf
{

namespace
{

void writeString(std::string_view text, std::string& out)
{
    static const char digits[] = "0123456789abcdef";
    out += '"';
    std::size_t clean = 0; // the start of the text that is not copied yet
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        const unsigned char byte = static_cast<unsigned char>(text[i]);
        if (byte >= 0x20 && byte != '"' && byte != '\\') continue;
        out += text.substr(clean, i - clean);
        out += "\\u00";
        out += digits[byte >> 4];
        out += digits[byte & 15];
        clean = i + 1;
    }
    out += text.substr(clean);
    out += '"';
}

void writeNumber(double number, std::string& out)
{
    const double largestExact = 9007199254740992.0;
    char text[32];
    const bool integer = std::trunc(number) == number && std::abs(number) <= largestExact;
    const std::to_chars_result end = integer ? std::to_chars(text, text + sizeof(text), std::int64_t(number))
                                             : std::to_chars(text, text + sizeof(text), number);
    out.append(text, end.ptr);
}

// The recursion is as deep as the tree, which the reader limits.
void write(const JsonValue& value, std::string& out)
{
    bool first = true;
    switch (value.type())
    {
    case JsonTree::Type::Null:
        out += "null";
        break;
    case JsonTree::Type::Boolean:
        out += value.boolean() ? "true" : "false";
        break;
    case JsonTree::Type::Number:
        writeNumber(value.number(), out);
        break;
    case JsonTree::Type::String:
        writeString(value.text(), out);
        break;
    case JsonTree::Type::Array:
        for (const JsonValue& element : value)
        {
            out += first ? '[' : ',';
            write(element, out);
            first = false;
        }
        out += first ? "[]" : "]";
        break;
    case JsonTree::Type::Object:
        for (const JsonValue& member : value)
        {
            out += first ? '{' : ',';
            writeString(member.key(), out);
            out += ':';
            write(member, out);
            first = false;
        }
        out += first ? "{}" : "}";
        break;
    }
}

} // namespace

std::string writeJson(const JsonValue& value)
{
    std::string out;
    write(value, out);
    return out;
}

} // namespace osgGpuAnimation::gltf
