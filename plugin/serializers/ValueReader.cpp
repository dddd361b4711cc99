// SPDX-License-Identifier: MIT
#include "serializers/ValueReader.h"

#include "serializers/NameToken.h"

#include <algorithm>
#include <charconv>

namespace osgGpuAnimation::serializers
{

namespace
{

constexpr std::size_t longestName = 1 << 20;
constexpr std::size_t floatsAtOnce = 1 << 16;

} // namespace

void ValueReader::fail(const std::string& message)
{
    if (isGood()) _stream.throwException("osgGpuAnimation: " + message);
}

/// Has the stream say whether it has come to its end.
void ValueReader::check()
{
    if (_stream.isBinary()) _stream >> std::dec;
}

std::string ValueReader::word()
{
    std::string read;
    if (!isGood()) return read;
    _stream >> read;
    if (read.empty()) fail("the file ends too early");
    return isGood() ? read : std::string();
}

template <typename Number>
Number ValueReader::parsed()
{
    const std::string read = word();
    Number number = 0;
    const auto [end, fault] = std::from_chars(read.data(), read.data() + read.size(), number);
    if (fault == std::errc() && end == read.data() + read.size()) return number;
    fail("\"" + read + "\" is there instead of a number");
    return 0;
}

ValueReader& ValueReader::property(const char* name)
{
    if (!isGood() || _stream.isBinary()) return *this;
    const std::string read = word();
    if (read != name) fail("\"" + read + "\" is there instead of \"" + name + "\"");
    return *this;
}

std::int32_t ValueReader::integer()
{
    if (!_stream.isBinary()) return parsed<std::int32_t>();
    std::int32_t value = 0;
    if (isGood()) _stream >> value;
    return isGood() ? value : 0;
}

std::int32_t ValueReader::integer(const char* subject, std::int32_t least, std::int32_t most)
{
    const std::int32_t value = integer();
    if (value >= least && value <= most) return value;
    fail(std::string(subject) + " is " + std::to_string(value) + ", not one of " + std::to_string(least) + " to " +
         std::to_string(most));
    return least;
}

std::size_t ValueReader::count()
{
    if (!_stream.isBinary()) return parsed<std::uint32_t>();
    std::uint32_t value = 0;
    if (isGood()) _stream >> value;
    return isGood() ? value : 0;
}

double ValueReader::real()
{
    if (!_stream.isBinary()) return parsed<double>();
    double value = 0.0;
    if (isGood()) _stream >> value;
    return isGood() ? value : 0.0;
}

std::string ValueReader::text()
{
    if (!_stream.isBinary()) return fromToken(word());
    const std::size_t length = count();
    if (length > longestName) fail("a name of " + std::to_string(length) + " characters");
    if (!isGood()) return {};
    std::string value(length, '\0');
    _stream.readCharArray(value.data(), static_cast<unsigned int>(length));
    check();
    return value;
}

void ValueReader::floats(float* out, std::size_t count)
{
    std::vector<float> values;
    floats(values, count);
    values.resize(count, 0.0f);
    std::copy(values.begin(), values.end(), out);
}

void ValueReader::floats(std::vector<float>& out, std::size_t count)
{
    if (!_stream.isBinary())
    {
        for (std::size_t i = 0; i < count && isGood(); ++i)
            out.push_back(parsed<float>());
        return;
    }
    for (std::size_t done = 0; done < count && isGood();)
    {
        const std::size_t step = std::min(floatsAtOnce, count - done);
        out.resize(out.size() + step);
        _stream.readComponentArray(reinterpret_cast<char*>(out.data() + out.size() - step),
                                   static_cast<unsigned int>(step), 1, sizeof(float));
        check();
        done += step;
    }
}

std::size_t ValueReader::open(const char* name)
{
    property(name);
    const std::size_t size = count();
    begin();
    return isGood() ? size : 0;
}

void ValueReader::begin()
{
    if (isGood()) _stream >> _stream.BEGIN_BRACKET;
}

void ValueReader::close()
{
    if (isGood()) _stream >> _stream.END_BRACKET;
}

std::vector<float> ValueReader::block(const char* name)
{
    std::vector<float> values;
    const std::size_t size = open(name);
    floats(values, size);
    close();
    return values;
}

} // namespace osgGpuAnimation::serializers
