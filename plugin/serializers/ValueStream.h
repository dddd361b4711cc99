// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/JointTransform.h>
#include <osgGpuAnimation/math/Result.h>

#include <glm/vec3.hpp>
#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace osgGpuAnimation::serializers
{

/// Reads or writes the values of an .osgb, .osgt or .osgx file. One function describes how a type is stored and serves
/// both directions:
///
///     void transferMarker(ValueStream& stream, ClipMarker& marker)
///     {
///         stream.property("Marker").values(marker.time, marker.name).endLine();
///     }
///
/// The text formats hold one property a line; each number has the digits that restore it exactly.
///
/// A file is untrusted. The first fault (a word instead of a number, an unexpected property, the end of the file) makes
/// the whole file unreadable, with a message; all values after it read as 0 or empty, so loops test isGood(). Memory
/// grows with the values read, never with a count that the file announces.
class ValueStream
{
public:
    explicit ValueStream(osgDB::InputStream& in) : _in(&in) {}
    explicit ValueStream(osgDB::OutputStream& out) : _out(&out) {}

    bool isReading() const { return _in != nullptr; }
    bool isGood() const { return !_in || !_in->getException(); }
    /// True if an object can take the values: they were read, without a fault.
    bool hasRead() const { return isReading() && isGood(); }
    /// Makes the file unreadable; the first message stays.
    void fail(const std::string& message);
    /// The same if the subject has refused a value.
    template <typename Type>
    void require(const char* subject, const Result<Type>& taken)
    {
        if (!taken) fail(subject + taken.error().message);
    }

    ValueStream& property(const char* name);
    ValueStream& value(std::int32_t& integer) { return number(integer); }
    ValueStream& value(double& real) { return number(real); }
    ValueStream& value(bool& flag) { return as<std::int32_t>(flag); }
    ValueStream& value(std::string& text);
    ValueStream& value(glm::dvec3& vector) { return values(vector.x, vector.y, vector.z); }
    ValueStream& value(AffineMatrix& matrix);                                   ///< by rows
    ValueStream& value(std::size_t& count) { return as<std::uint32_t>(count); } ///< below 2^32
    template <typename... Values>
    ValueStream& values(Values&... each)
    {
        return (value(each), ...);
    }
    /// An integer in [min, max]; any other makes the file unreadable and reads as `min`.
    ValueStream& limited(const char* subject, std::int32_t& integer, std::int32_t min, std::int32_t max);
    /// The version of the format, of which there is one; another one makes the file unreadable.
    ValueStream& version(const char* subject);
    /// An enum whose values are 0 to `last`.
    template <typename Enum>
    ValueStream& limited(const char* subject, Enum& value, Enum last)
    {
        auto integer = static_cast<std::int32_t>(value);
        limited(subject, integer, 0, static_cast<std::int32_t>(last));
        value = static_cast<Enum>(integer);
        return *this;
    }
    ValueStream& floats(float* values, std::size_t count) { return numbers(values, count); }
    void endLine();

    /// Starts a property that holds `size` items; returns the number of items to transfer.
    std::size_t open(const char* name, std::size_t size);
    void begin(); ///< the same if the property's name is already transferred
    void close();

    /// A property that holds all items; reading replaces them. transferItem: void(Item&).
    template <typename Item, typename Transfer>
    void list(const char* name, std::vector<Item>& items, Transfer transferItem)
    {
        const std::size_t count = open(name, items.size());
        if (isReading()) items.clear();
        this->items(items, count, transferItem);
        close();
    }
    /// The items alone: between open() and close().
    template <typename Item, typename Transfer>
    void items(std::vector<Item>& items, std::size_t count, Transfer transferItem)
    {
        for (std::size_t i = 0; i < count && isGood(); ++i)
        {
            if (isReading()) items.emplace_back();
            transferItem(items[i]);
        }
    }

    /// Items that consist of numbers, `count` numbers together; reading expects an empty vector.
    template <typename Number, typename Item>
    ValueStream& numbers(std::vector<Item>& items, std::size_t count)
    {
        constexpr std::size_t perItem = sizeof(Item) / sizeof(Number), itemsAtOnce = 4096;
        for (std::size_t done = 0; done < count / perItem && isGood(); done += itemsAtOnce)
        {
            const std::size_t step = std::min(itemsAtOnce, count / perItem - done);
            if (isReading()) items.resize(done + step);
            numbers(reinterpret_cast<Number*>(items.data() + done), step * perItem);
        }
        if (count % perItem != 0) fail(std::to_string(count) + " numbers, not " + std::to_string(perItem) + " an item");
        return *this;
    }
    /// A property that holds numbers alone; the text formats break the line after each `perLine`.
    template <typename Number = float, typename Item>
    void block(const char* name, std::vector<Item>& items, std::size_t perLine)
    {
        const std::size_t count = open(name, items.size() * sizeof(Item) / sizeof(Number));
        if (isReading()) numbers<Number>(items, count);
        for (std::size_t done = 0; !isReading() && done < count; done += perLine)
            numbers(reinterpret_cast<Number*>(items.data()) + done, std::min(perLine, count - done)).endLine();
        close();
    }

    /// As OSG's textures store theirs: by the file's name or with its pixels, as the writer's options say.
    void image(osg::ref_ptr<osg::Image>& image)
    {
        if (_out) _out->writeImage(image.get());
        if (hasRead()) image = _in->readImage();
    }
    template <typename Type>
    void object(osg::ref_ptr<Type>& object)
    {
        if (_out) _out->writeObject(object.get());
        if (hasRead()) object = dynamic_cast<Type*>(_in->readObject().get());
    }

private:
    bool isBinary() const { return _in ? _in->isBinary() : _out->isBinary(); }
    template <typename Number>
    ValueStream& number(Number& value);
    template <typename Number>
    ValueStream& numbers(Number* values, std::size_t count);
    template <typename Stored, typename Value>
    ValueStream& as(Value& value)
    {
        auto stored = static_cast<Stored>(value);
        number(stored);
        value = static_cast<Value>(stored);
        return *this;
    }
    std::string word();
    ValueStream& readBytes(char* bytes, std::size_t count, std::size_t bytesEach);

    osgDB::InputStream* _in = nullptr;
    osgDB::OutputStream* _out = nullptr;
};

/// A property of a class in osgDB that one function reads and writes.
template <typename Class>
class Property : public osgDB::BaseSerializer
{
public:
    /// Reading sets the object's values after stream.hasRead(); writing leaves the object unchanged.
    using Transfer = void (*)(ValueStream& stream, Class& object);
    using Condition = bool (*)(const Class& object);

    /// isWritten: whether an object has the property. Null: every object has it, and a file without it is unreadable.
    Property(const char* name, Transfer transfer, Condition isWritten)
        : osgDB::BaseSerializer(READ_WRITE_PROPERTY), _name(name), _transfer(transfer), _isWritten(isWritten)
    {
    }

    const std::string& getName() const override { return _name; }

    bool write(osgDB::OutputStream& out, const osg::Object& object) override
    {
        const auto& owner = dynamic_cast<const Class&>(object);
        const bool isThere = !_isWritten || _isWritten(owner);
        if (out.isBinary())
            out << isThere;
        else if (isThere)
            out << out.PROPERTY(_name.c_str());
        ValueStream stream(out);
        if (isThere) _transfer(stream, const_cast<Class&>(owner));
        return true;
    }

    bool read(osgDB::InputStream& in, osg::Object& object) override
    {
        bool isThere = true;
        if (in.isBinary())
            in >> isThere;
        else
            isThere = in.matchString(_name);
        ValueStream stream(in);
        if (isThere && stream.isGood())
            _transfer(stream, dynamic_cast<Class&>(object));
        else if (!_isWritten)
            stream.fail("an object without its " + _name);
        return stream.isGood();
    }

private:
    std::string _name;
    Transfer _transfer;
    Condition _isWritten;
};

/// Adds a Property to an object wrapper.
template <typename Class>
void addProperty(osgDB::ObjectWrapper* wrapper, const char* name, void (*transfer)(ValueStream&, Class&),
                 bool (*isWritten)(const Class&) = nullptr)
{
    wrapper->addSerializer(new Property<Class>(name, transfer, isWritten), osgDB::BaseSerializer::RW_USER);
}

/// Registers a class of this kit in osgDB.
template <typename Class>
class Wrapper : public osgDB::RegisterWrapperProxy
{
public:
    /// name: without the namespace. bases: whose properties the class has before its own, separated by spaces.
    Wrapper(const std::string& name, const std::string& bases, AddPropFunc addProperties = nullptr)
        : osgDB::RegisterWrapperProxy([]() -> osg::Object* { return new Class; }, "osgGpuAnimation::" + name,
                                      bases + " osgGpuAnimation::" + name, addProperties)
    {
    }
    /// With one property.
    Wrapper(const std::string& name, const std::string& bases, const char* property,
            void (*transfer)(ValueStream&, Class&))
        : Wrapper(name, bases)
    {
        addProperty(_wrapper.get(), property, transfer);
    }
};

} // namespace osgGpuAnimation::serializers
