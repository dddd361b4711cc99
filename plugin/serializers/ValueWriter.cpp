// SPDX-License-Identifier: MIT
#include "serializers/ValueWriter.h"

#include "serializers/ExactNumbers.h"
#include "serializers/NameToken.h"

#include <algorithm>

namespace osgGpuAnimation::serializers
{

ValueWriter& ValueWriter::property(const char* name)
{
    _stream << _stream.PROPERTY(name);
    return *this;
}

ValueWriter& ValueWriter::integer(std::int32_t value)
{
    _stream << value;
    return *this;
}

ValueWriter& ValueWriter::count(std::size_t value)
{
    _stream << static_cast<unsigned int>(value);
    return *this;
}

ValueWriter& ValueWriter::real(double value)
{
    if (_stream.isBinary())
        _stream << value;
    else
        _stream << &exactDoubles << value << &exactFloats;
    return *this;
}

ValueWriter& ValueWriter::text(const std::string& value)
{
    if (_stream.isBinary())
    {
        count(value.size());
        _stream.writeCharArray(value.data(), static_cast<unsigned int>(value.size()));
    }
    else
        _stream << toToken(value);
    return *this;
}

ValueWriter& ValueWriter::floats(const float* values, std::size_t count)
{
    if (_stream.isBinary())
    {
        constexpr std::size_t most = std::size_t(1) << 28; // an unsigned int of bytes
        for (std::size_t done = 0; done < count; done += std::min(most, count - done))
            _stream.writeCharArray(reinterpret_cast<const char*>(values + done),
                                   static_cast<unsigned int>(std::min(most, count - done) * sizeof(float)));
        return *this;
    }
    _stream << &exactFloats;
    for (std::size_t i = 0; i < count; ++i)
        _stream << values[i];
    return *this;
}

ValueWriter& ValueWriter::object(const osg::Object* value)
{
    _stream.writeObject(value);
    return *this;
}

void ValueWriter::endLine()
{
    _stream << std::endl;
}

void ValueWriter::open(const char* name, std::size_t size)
{
    property(name).count(size);
    begin();
}

void ValueWriter::begin()
{
    _stream << _stream.BEGIN_BRACKET;
    endLine();
}

void ValueWriter::close()
{
    _stream << _stream.END_BRACKET;
    endLine();
}

void ValueWriter::block(const char* name, const float* values, std::size_t size, std::size_t perLine)
{
    open(name, size);
    for (std::size_t done = 0; done < size; done += std::min(perLine, size - done))
    {
        floats(values + done, std::min(perLine, size - done));
        endLine();
    }
    close();
}

} // namespace osgGpuAnimation::serializers
