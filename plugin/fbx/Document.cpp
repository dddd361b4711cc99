// SPDX-License-Identifier: MIT
#include "fbx/Document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include <zlib.h>

namespace osgGpuAnimation::fbx
{

namespace
{

constexpr std::string_view magic("Kaydara FBX Binary");
constexpr std::size_t headerBytes = 27;
constexpr int maxDepth = 64;

template <class Number>
Number littleEndian(const char* bytes)
{
    Number number;
    std::memcpy(&number, bytes, sizeof(number)); // of x86-64 and arm64, as elsewhere in the kit
    return number;
}

/// Of an element of an array of that type.
std::size_t bytesOf(char type)
{
    return type == 'd' || type == 'l' ? 8 : type == 'b' || type == 'c' ? 1 : 4;
}

double parsedNumber(std::string_view text)
{
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double number = 0.0;
    const std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), number);
    return read.ec == std::errc() && read.ptr == text.data() + text.size() ? number
                                                                           : std::numeric_limits<double>::quiet_NaN();
}

class BinaryParser
{
public:
    BinaryParser(std::string_view bytes, int version) : _bytes(bytes), _isWide(version >= 7500) {}

    Result<void> parse(Element& root) { return records(headerBytes, _bytes.size(), root, 1); }

private:
    std::size_t recordBytes() const { return _isWide ? 25 : 13; }

    std::uint64_t headerNumber(std::size_t at, std::size_t index) const
    {
        return _isWide ? littleEndian<std::uint64_t>(&_bytes[at + 8 * index])
                       : littleEndian<std::uint32_t>(&_bytes[at + 4 * index]);
    }

    static Error broken(std::size_t at, const char* what)
    {
        return {"FBX record at byte " + std::to_string(at) + ": " + what};
    }

    Result<void> records(std::size_t at, std::size_t limit, Element& parent, int depth)
    {
        // The record of zeros that ends the list may be missing where the file ends.
        const std::size_t least = depth == 1 ? recordBytes() : 1;
        while (at + least <= limit)
        {
            Element child;
            const Result<std::size_t> next = record(at, limit, child, depth);
            if (!next) return next.error();
            if (next.value() == 0) break;
            parent.children.push_back(std::move(child));
            at = next.value();
        }
        return {};
    }

    /// The end of the record; 0: the record that ends a list.
    Result<std::size_t> record(std::size_t at, std::size_t limit, Element& element, int depth)
    {
        if (at + recordBytes() > limit) return broken(at, "expected a record, found the end");
        if (depth > maxDepth) return broken(at, "nested too deep");
        const std::uint64_t end = headerNumber(at, 0), count = headerNumber(at, 1), length = headerNumber(at, 2);
        const std::size_t nameLength = static_cast<unsigned char>(_bytes[at + recordBytes() - 1]);
        if (end == 0) return std::size_t(0);
        std::size_t position = at + recordBytes() + nameLength;
        if (end > limit || position > end || length > end - position)
            return broken(at, "it ends beyond the records around it");
        element.name = _bytes.substr(at + recordBytes(), nameLength);
        const std::size_t endOfValues = position + static_cast<std::size_t>(length);
        for (std::uint64_t i = 0; i < count; ++i)
            if (!addValue(position, endOfValues, element)) return broken(at, "a value ends beyond it");
        if (const Result<void> read = records(endOfValues, static_cast<std::size_t>(end), element, depth + 1); !read)
            return read.error();
        return static_cast<std::size_t>(end);
    }

    bool addValue(std::size_t& position, std::size_t end, Element& element)
    {
        if (position >= end) return false;
        const char type = _bytes[position++];
        Value value;
        const auto number = [&](auto example)
        {
            if (end - position < sizeof(example)) return false;
            const auto read = littleEndian<decltype(example)>(&_bytes[position]);
            value.number = static_cast<double>(read);
            if constexpr (std::is_integral_v<decltype(example)>) value.integer = read;
            position += sizeof(example);
            element.values.push_back(value);
            return true;
        };
        switch (type)
        {
        case 'C':
        case 'B':
            return number(std::int8_t());
        case 'Y':
            return number(std::int16_t());
        case 'I':
            return number(std::int32_t());
        case 'L':
            return number(std::int64_t());
        case 'F':
            return number(float());
        case 'D':
            return number(double());
        case 'S':
        case 'R':
        {
            if (end - position < 4) return false;
            const std::size_t length = littleEndian<std::uint32_t>(&_bytes[position]);
            position += 4;
            if (end - position < length) return false;
            value.text = _bytes.substr(position, length);
            value.isText = true;
            position += length;
            element.values.push_back(value);
            return true;
        }
        default:
            return addArray(type, position, end, element);
        }
    }

    bool addArray(char type, std::size_t& position, std::size_t end, Element& element)
    {
        if (!std::strchr("fdlibc", type) || type == 0 || end - position < 12) return false;
        element.arrayType = type;
        element.arrayCount = littleEndian<std::uint32_t>(&_bytes[position]);
        element.isDeflated = littleEndian<std::uint32_t>(&_bytes[position + 4]) == 1;
        const std::size_t given = littleEndian<std::uint32_t>(&_bytes[position + 8]);
        const std::size_t stored = element.isDeflated ? given : bytesOf(type) * element.arrayCount;
        position += 12;
        if (end - position < stored) return false;
        element.array = _bytes.substr(position, stored);
        position += stored;
        element.values.emplace_back();
        return true;
    }

    std::string_view _bytes;
    bool _isWide; ///< from 7.5 on, the numbers in front of a record have 64 bits
};

class TextParser
{
public:
    explicit TextParser(std::string_view text) : _text(text) {}

    Result<void> parse(Element& root) { return elements(root, 1, false); }

private:
    char peek() const { return _at < _text.size() ? _text[_at] : '\0'; }
    bool atEnd() const { return _at >= _text.size(); }

    void skipLine()
    {
        while (!atEnd() && peek() != '\n')
            ++_at;
    }
    void skipSpace(bool overLines)
    {
        for (; !atEnd(); ++_at)
        {
            if (peek() == ';' && overLines) skipLine();
            const bool isSpace = peek() == ' ' || peek() == '\t' || peek() == '\r' || (overLines && peek() == '\n');
            if (!isSpace) return;
        }
    }
    std::string_view word()
    {
        const std::size_t start = _at;
        while (!atEnd() && !std::strchr(" \t\r\n:,{};\"", peek()))
            ++_at;
        return _text.substr(start, _at - start);
    }

    Error broken(const char* expected) const
    {
        return {"FBX text at byte " + std::to_string(_at) + ": expected " + expected + ", found " +
                (atEnd() ? "the end" : std::string("\"") + (peek() >= ' ' && peek() <= '~' ? peek() : '?') + '"')};
    }

    Result<void> elements(Element& parent, int depth, bool isInBraces)
    {
        if (depth > maxDepth) return broken("fewer braces");
        while (true)
        {
            skipSpace(true);
            if (atEnd()) return isInBraces ? Result<void>(broken("\"}\"")) : Result<void>();
            if (peek() == '}')
            {
                if (!isInBraces) return broken("a name");
                ++_at;
                return {};
            }
            Element element;
            element.name = word();
            skipSpace(false);
            if (element.name.empty() || peek() != ':') return broken("a name with \":\"");
            ++_at;
            if (element.name == "a" && isInBraces)
                readArray(element);
            else if (const Result<void> read = values(element, depth); !read)
                return read.error();
            parent.children.push_back(std::move(element));
        }
    }

    void readArray(Element& element)
    {
        const std::size_t end = std::min(_text.find('}', _at), _text.size());
        element.array = _text.substr(_at, end - _at);
        _at = end;
    }

    Result<void> values(Element& element, int depth)
    {
        bool isAfterComma = false;
        while (true)
        {
            skipSpace(isAfterComma);
            const char next = peek();
            if (atEnd() || next == '\n' || next == ';' || next == '}') return {};
            if (next == '{')
            {
                ++_at;
                return elements(element, depth + 1, true);
            }
            isAfterComma = next == ',';
            if (isAfterComma)
                ++_at;
            else if (!addValue(element))
                return broken("a value");
        }
    }

    bool addValue(Element& element)
    {
        Value value;
        if (peek() == '"')
        {
            const std::size_t end = _text.find('"', _at + 1);
            if (end == std::string_view::npos) return false;
            value.text = _text.substr(_at + 1, end - _at - 1);
            value.isText = true;
            _at = end + 1;
        }
        else
        {
            value.text = word();
            if (value.text.empty()) return false;
            value.number = parsedNumber(value.text);
            value.isText = std::isnan(value.number) && value.text.front() != '*';
            std::from_chars(value.text.data(), value.text.data() + value.text.size(), value.integer);
        }
        element.values.push_back(value);
        return true;
    }

    std::string_view _text;
    std::size_t _at = 0;
};

template <class Number>
std::vector<double> converted(std::string_view bytes)
{
    std::vector<double> numbers(bytes.size() / sizeof(Number));
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = static_cast<double>(littleEndian<Number>(&bytes[i * sizeof(Number)]));
    return numbers;
}

std::string inflated(std::string_view stored, std::size_t bytes)
{
    constexpr std::size_t maxRatio = 1100; // deflate reaches 1032
    if (bytes > maxRatio * (stored.size() + 1)) return {};
    std::string content(bytes, '\0');
    uLongf length = bytes;
    const int status = uncompress(reinterpret_cast<Bytef*>(content.data()), &length,
                                  reinterpret_cast<const Bytef*>(stored.data()), stored.size());
    return status == Z_OK && length == bytes ? content : std::string();
}

std::vector<double> textNumbers(std::string_view text)
{
    std::vector<double> numbers;
    while (!text.empty())
    {
        const std::size_t start = text.find_first_not_of(" \t\r\n,");
        if (start == std::string_view::npos) break;
        const std::size_t end = std::min(text.find_first_of(" \t\r\n,", start), text.size());
        numbers.push_back(parsedNumber(text.substr(start, end - start)));
        text.remove_prefix(end);
    }
    return numbers;
}

} // namespace

const Element* Element::child(std::string_view childName) const
{
    for (const Element& each : children)
        if (each.name == childName) return &each;
    return nullptr;
}

std::vector<double> Element::numbers() const
{
    if (const Element* const content = child("a")) return textNumbers(content->array);
    if (arrayType == 0) return {};
    const std::string decoded = isDeflated ? inflated(array, bytesOf(arrayType) * arrayCount) : std::string();
    const std::string_view bytes = isDeflated ? std::string_view(decoded) : array;
    switch (arrayType)
    {
    case 'd':
        return converted<double>(bytes);
    case 'f':
        return converted<float>(bytes);
    case 'l':
        return converted<std::int64_t>(bytes);
    case 'i':
        return converted<std::int32_t>(bytes);
    default:
        return converted<std::int8_t>(bytes);
    }
}

std::vector<double> Element::numbers(std::string_view childName) const
{
    const Element* const found = child(childName);
    return found ? found->numbers() : std::vector<double>();
}

double floatOfBits(double number)
{
    constexpr double smallestNormal = 8388608.0; // bits below are those of denormal numbers
    if (number != std::floor(number) || std::abs(number) < smallestNormal || number > 4294967295.0 ||
        number < -2147483648.0)
        return number;
    const auto bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(number));
    float value = 0.0f;
    std::memcpy(&value, &bits, sizeof(value));
    return std::isfinite(value) ? static_cast<double>(value) : number;
}

Result<Document> Document::parse(std::string_view bytes)
{
    Document document;
    if (bytes.substr(0, magic.size()) == magic)
    {
        if (bytes.size() < headerBytes)
            return Error{"FBX header: expected " + std::to_string(headerBytes) + " bytes, found " +
                         std::to_string(bytes.size())};
        document.version = static_cast<int>(littleEndian<std::uint32_t>(&bytes[headerBytes - 4]));
        if (const Result<void> read = BinaryParser(bytes, document.version).parse(document.root); !read)
            return read.error();
        return document;
    }
    if (const Result<void> read = TextParser(bytes).parse(document.root); !read) return read.error();
    const Element* const header = document.root.child("FBXHeaderExtension");
    const Element* const version = header ? header->child("FBXVersion") : nullptr;
    if (!version || version->values.empty()) return Error{"it is no FBX file: FBXVersion is missing"};
    document.version = static_cast<int>(std::clamp<std::int64_t>(version->values[0].integer, 0, 100000));
    return document;
}

} // namespace osgGpuAnimation::fbx
