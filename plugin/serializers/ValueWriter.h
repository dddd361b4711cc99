// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/OutputStream>

#include <cstddef>
#include <cstdint>
#include <string>

namespace osgGpuAnimation::serializers
{

/// Numbers and names on the way to an .osgb, .osgt or .osgx: exactly, and in the text formats for people to read, a
/// property a line.
///
///     ValueWriter out(stream);
///     out.property("Joint").integer(parent).text(name).floats(&rest.translation.x, 3).endLine();
class ValueWriter
{
public:
    explicit ValueWriter(osgDB::OutputStream& stream) : _stream(stream) {}

    ValueWriter& property(const char* name);
    ValueWriter& integer(std::int32_t value);
    ValueWriter& count(std::size_t value); ///< below 2^32
    ValueWriter& flag(bool value) { return integer(value ? 1 : 0); }
    ValueWriter& real(double value);
    ValueWriter& text(const std::string& value);
    ValueWriter& floats(const float* values, std::size_t count); ///< on this line
    ValueWriter& object(const osg::Object* value);
    void endLine();

    /// A property that holds so many others.
    void open(const char* name, std::size_t count);
    void begin(); ///< the same where the name is there already
    void close();
    /// A property that holds nothing but numbers, in lines of so many.
    void block(const char* name, const float* values, std::size_t count, std::size_t perLine);

private:
    osgDB::OutputStream& _stream;
};

} // namespace osgGpuAnimation::serializers
