// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/ObjectWrapper>
#include <osgDB/Serializer>

namespace osgGpuAnimation::serializers
{

/// A property without which the object is none: where others are passed over if a file does not have them, this makes
/// the file unreadable. It is always written.
template <typename Class>
class RequiredProperty : public osgDB::UserSerializer<Class>
{
public:
    using Base = osgDB::UserSerializer<Class>;

    RequiredProperty(const char* name, typename Base::Reader reader, typename Base::Writer writer)
        : Base(
              name, [](const Class&) { return true; }, reader, writer)
    {
    }

    bool read(osgDB::InputStream& stream, osg::Object& object) override
    {
        bool isThere = true;
        if (stream.isBinary())
            stream >> isThere;
        else
            isThere = stream.matchString(this->getName());
        if (isThere && !stream.getException()) return (*this->_reader)(stream, OBJECT_CAST<Class&>(object));
        if (!stream.getException()) stream.throwException("osgGpuAnimation: an object without its " + this->getName());
        return false;
    }
};

} // namespace osgGpuAnimation::serializers

/// In an object wrapper: the property of this name, read##PROP and write##PROP.
#define ADD_REQUIRED_SERIALIZER(PROP)                                                                                  \
    wrapper->addSerializer(                                                                                            \
        new osgGpuAnimation::serializers::RequiredProperty<MyClass>(#PROP, &read##PROP, &write##PROP),                 \
        osgDB::BaseSerializer::RW_USER)
