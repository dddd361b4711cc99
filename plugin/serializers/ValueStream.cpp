// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

#include <cctype>
#include <charconv>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::size_t maxNameBytes = 1 << 20;

/// A name as one word of plain characters, percent-encoded like a URI ("Hand R" is Hand%20R, the empty name is %): OSG
/// 3.6 reads beyond the end of a file that is cut off inside a quoted string.
std::string toToken(const std::string& name)
{
    constexpr char digits[] = "0123456789ABCDEF";
    std::string token;
    for (const char character : name)
    {
        const auto byte = static_cast<unsigned char>(character);
        if (byte < 128 && (std::isalnum(byte) || character == '_' || character == '.'))
            token += character;
        else
            token += {'%', digits[byte / 16], digits[byte % 16]};
    }
    return token.empty() ? "%" : token;
}

/// Decodes a token; keeps a faulty percent code unchanged.
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

} // namespace

void ValueStream::fail(const std::string& message)
{
    if (hasRead()) _in->throwException("osgGpuAnimation: " + message);
}

/// Values of a binary file, in its byte order.
ValueStream& ValueStream::readBytes(char* bytes, std::size_t count, std::size_t bytesEach)
{
    if (!isGood()) return *this;
    const auto size = static_cast<unsigned int>(bytesEach);
    _in->readComponentArray(bytes, static_cast<unsigned int>(count), 1, size);
    *_in >> std::dec; // makes the stream report its end: reading bytes alone does not
    return *this;
}

std::string ValueStream::word()
{
    std::string read;
    if (!isGood()) return read;
    *_in >> read;
    if (read.empty()) fail("the file ends too early");
    return isGood() ? read : std::string();
}

template <typename Number>
ValueStream& ValueStream::number(Number& value)
{
    char digits[32];
    if (_out && isBinary())
        *_out << value;
    else if (_out)
        *_out << std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    else if (isBinary() && isGood())
        *_in >> value;
    else if (isGood())
    {
        const std::string read = word();
        const auto [end, fault] = std::from_chars(read.data(), read.data() + read.size(), value);
        if (fault != std::errc() || end != read.data() + read.size()) fail("expected a number, found \"" + read + "\"");
    }
    if (!isGood()) value = 0;
    return *this;
}

template ValueStream& ValueStream::number(std::int32_t&);
template ValueStream& ValueStream::number(std::uint32_t&);
template ValueStream& ValueStream::number(double&);

ValueStream& ValueStream::property(const char* name)
{
    if (_out) *_out << _out->PROPERTY(name);
    if (!hasRead() || isBinary()) return *this;
    const std::string read = word();
    if (read != name) fail("expected \"" + std::string(name) + "\", found \"" + read + "\"");
    return *this;
}

ValueStream& ValueStream::value(std::string& text)
{
    if (!isBinary())
    {
        if (_out)
            *_out << toToken(text);
        else
            text = fromToken(word());
        return *this;
    }
    std::size_t length = text.size();
    value(length);
    if (_out) _out->writeCharArray(text.data(), static_cast<unsigned int>(length));
    if (_out) return *this;
    if (length > maxNameBytes) fail("a name of " + std::to_string(length) + " characters");
    text.assign(isGood() ? length : 0, '\0');
    return readBytes(text.data(), text.size(), 1);
}

ValueStream& ValueStream::value(AffineMatrix& matrix)
{
    for (glm::vec4& row : matrix.rows)
        floats(&row.x, 4);
    return *this;
}

ValueStream& ValueStream::limited(const char* subject, std::int32_t& integer, std::int32_t min, std::int32_t max)
{
    number(integer);
    if (integer >= min && integer <= max) return *this;
    fail(std::string(subject) + " is " + std::to_string(integer) + ", not one of " + std::to_string(min) + " to " +
         std::to_string(max));
    integer = min;
    return *this;
}

ValueStream& ValueStream::version(const char* subject)
{
    constexpr std::int32_t expected = 1;
    std::int32_t found = expected;
    number(found);
    if (found != expected)
        fail(std::string(subject) + " has version " + std::to_string(found) + ", expected " + std::to_string(expected));
    return *this;
}

template <typename Number>
ValueStream& ValueStream::numbers(Number* values, std::size_t count)
{
    if (!isBinary())
        for (std::size_t i = 0; i < count; ++i)
            number(values[i]);
    else if (_out)
        _out->writeCharArray(reinterpret_cast<const char*>(values), static_cast<unsigned int>(count * sizeof(Number)));
    else
        readBytes(reinterpret_cast<char*>(values), count, sizeof(Number));
    return *this;
}

template ValueStream& ValueStream::numbers(float*, std::size_t);
template ValueStream& ValueStream::numbers(std::uint16_t*, std::size_t);
template ValueStream& ValueStream::numbers(std::uint32_t*, std::size_t);

void ValueStream::endLine()
{
    if (_out) *_out << std::endl;
}

std::size_t ValueStream::open(const char* name, std::size_t size)
{
    property(name).value(size);
    begin();
    return isGood() ? size : 0;
}

void ValueStream::begin()
{
    if (hasRead()) *_in >> _in->BEGIN_BRACKET;
    if (_out) *_out << _out->BEGIN_BRACKET << std::endl;
}

void ValueStream::close()
{
    if (hasRead()) *_in >> _in->END_BRACKET;
    if (_out) *_out << _out->END_BRACKET << std::endl;
}

} // namespace osgGpuAnimation::serializers
