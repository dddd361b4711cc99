// SPDX-License-Identifier: MIT
#include "serializers/NameToken.h"

#include <cctype>
#include <charconv>
#include <cstdint>

namespace osgGpuAnimation::serializers
{

namespace
{

/// Those that mean something to neither of the text formats.
bool isPlain(unsigned char character)
{
    return character < 128 && (std::isalnum(character) || character == '_' || character == '.');
}

} // namespace

std::string toToken(const std::string& name)
{
    constexpr char digits[] = "0123456789ABCDEF";
    std::string token;
    for (const char character : name)
    {
        const auto byte = static_cast<unsigned char>(character);
        if (isPlain(byte))
            token += character;
        else
            token += {'%', digits[byte / 16], digits[byte % 16]};
    }
    return token.empty() ? "%" : token;
}

std::string fromToken(const std::string& token)
{
    std::string name;
    if (token == "%") return name;
    for (std::size_t i = 0; i < token.size(); ++i)
    {
        std::uint8_t byte = 0;
        const char* digits = token.data() + i + 1;
        const bool isCode =
            token[i] == '%' && i + 2 < token.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
        name += isCode ? static_cast<char>(byte) : token[i];
        if (isCode) i += 2;
    }
    return name;
}

} // namespace osgGpuAnimation::serializers
