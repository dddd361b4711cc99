// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/InputStream>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgGpuAnimation::serializers
{

/// Reads what ValueWriter wrote. The file is not trusted: the first fault (a word that is no number, another property
/// than the one expected, the end of the file) makes the whole file unreadable, with a message, and from then on
/// everything reads as 0 or nothing; loops look at isGood(). Memory grows with what is read, not with what is
/// announced.
class ValueReader
{
public:
    explicit ValueReader(osgDB::InputStream& stream) : _stream(stream) {}

    bool isGood() const { return !_stream.getException(); }
    /// Makes the file unreadable; the first message stays.
    void fail(const std::string& message);

    ValueReader& property(const char* name);
    std::int32_t integer();
    /// A number in [least, most]; else least, and the file is at fault.
    std::int32_t integer(const char* subject, std::int32_t least, std::int32_t most);
    std::size_t count();
    bool flag() { return integer() != 0; }
    double real();
    std::string text();
    /// Appends so many.
    void floats(std::vector<float>& out, std::size_t count);
    void floats(float* out, std::size_t count);
    osg::ref_ptr<osg::Object> object() { return isGood() ? _stream.readObject() : nullptr; }
    template <typename Type>
    osg::ref_ptr<Type> objectOf()
    {
        const osg::ref_ptr<osg::Object> read = object();
        return dynamic_cast<Type*>(read.get());
    }

    std::size_t open(const char* name); ///< how many there are to come
    void begin();
    void close();
    /// A block of numbers.
    std::vector<float> block(const char* name);

private:
    std::string word();
    template <typename Number>
    Number parsed();
    void check();

    osgDB::InputStream& _stream;
};

} // namespace osgGpuAnimation::serializers
