// SPDX-License-Identifier: MIT
#include "gltf/ElementName.h"

#include <charconv>

namespace osgGpuAnimation::gltf
{

std::string printable(std::string_view text, std::size_t most)
{
    static const char digits[] = "0123456789abcdef";
    std::string out;
    for (char c : text.substr(0, most))
    {
        const unsigned char byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f)
            out += c;
        else
            out += std::string("\\x") + digits[byte >> 4] + digits[byte & 15];
    }
    if (text.size() > most) out += "...";
    return out;
}

std::string quoted(std::string_view text)
{
    return '"' + printable(text) + '"';
}

std::string numberText(double number)
{
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof(text), number).ptr);
}

Error fault(std::string_view element, std::string_view expected, std::string_view found)
{
    return Error{std::string(element) + ": expected " + std::string(expected) + ", found " + std::string(found)};
}

} // namespace osgGpuAnimation::gltf
