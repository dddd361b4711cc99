// SPDX-License-Identifier: MIT
#include "gltf/Uri.h"

#include "gltf/ElementName.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace osgGpuAnimation::gltf
{

namespace
{

Error unexpected(const std::string& expected, const std::string& found)
{
    return Error{"expected " + expected + ", found " + found};
}

int hexDigit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

Result<std::string> decodePercent(std::string_view text)
{
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        if (text[i] != '%')
        {
            out += text[i];
            continue;
        }
        const int high = i + 1 < text.size() ? hexDigit(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hexDigit(text[i + 2]) : -1;
        if (high < 0 || low < 0) return unexpected("two hexadecimal digits after %", quoted(text.substr(i, 3)));
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

/// The value of each base64 digit, 255 for other characters.
constexpr std::array<std::uint8_t, 256> base64Values()
{
    std::array<std::uint8_t, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = 255;
    const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < digits.size(); ++i)
        values[std::size_t(digits[i])] = std::uint8_t(i);
    return values;
}

Result<std::vector<unsigned char>> decodeBase64(std::string_view text)
{
    static constexpr std::array<std::uint8_t, 256> values = base64Values();
    for (int padding = 0; padding < 2 && !text.empty() && text.back() == '='; ++padding)
        text.remove_suffix(1);
    std::vector<unsigned char> out;
    out.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        const std::uint8_t value = values[static_cast<unsigned char>(text[i])];
        if (value == 255)
            return unexpected("base64",
                              quoted(text.substr(i, 1)) + " at character " + std::to_string(i) + " of the data");
        bits = bits << 6 | value;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        out.push_back(static_cast<unsigned char>(bits >> count));
    }
    if (count == 6) return unexpected("base64", "data that ends in the middle of a byte");
    return out;
}

Result<std::vector<unsigned char>> decodePayload(std::string_view payload, bool base64)
{
    if (base64) return decodeBase64(payload);
    const Result<std::string> text = decodePercent(payload);
    if (!text) return text.error();
    return std::vector<unsigned char>(text.value().begin(), text.value().end());
}

bool equalsIgnoringCase(std::string_view text, std::string_view lower)
{
    return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

/// http: or C: at the beginning (RFC 3986, section 3.1).
bool hasScheme(std::string_view uri)
{
    if (uri.empty() || !std::isalpha(static_cast<unsigned char>(uri[0]))) return false;
    const std::size_t end =
        std::find_if(uri.begin(), uri.end(),
                     [](char c)
                     { return !std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '-' && c != '.'; }) -
        uri.begin();
    return end < uri.size() && uri[end] == ':';
}

} // namespace

bool isDataUri(std::string_view uri)
{
    return equalsIgnoringCase(uri.substr(0, 5), "data:");
}

Result<DataUri> decodeDataUri(std::string_view uri, std::size_t most)
{
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) return unexpected("a comma and data after data:", quoted(uri));
    std::string_view kind = uri.substr(5, comma - 5);
    const std::string_view payload = uri.substr(comma + 1);
    const std::string_view marker = ";base64";
    const bool base64 =
        kind.size() >= marker.size() && equalsIgnoringCase(kind.substr(kind.size() - marker.size()), marker);
    if (payload.size() / 4 * 3 > most) return unexpected("at most " + std::to_string(most) + " bytes", "more");
    Result<std::vector<unsigned char>> bytes = decodePayload(payload, base64);
    if (!bytes) return bytes.error();
    return DataUri{std::string(kind.substr(0, kind.find(';'))), std::move(bytes).value()};
}

Result<std::string> decodePath(std::string_view uri)
{
    if (uri.empty()) return unexpected("a relative path or a data URI", "an empty text");
    if (hasScheme(uri)) return unexpected("a relative path or a data URI", quoted(uri));
    Result<std::string> path = decodePercent(uri);
    if (!path) return path;
    if (path.value().find('\0') != std::string::npos) return unexpected("a path without NUL", quoted(uri));
    if (path.value().find('\\') != std::string::npos)
        return unexpected("a path with slashes, not backslashes", quoted(uri));
    return path;
}

} // namespace osgGpuAnimation::gltf
