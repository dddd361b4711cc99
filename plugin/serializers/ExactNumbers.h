// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/ObjectWrapper>

#include <ios>

namespace osgGpuAnimation::serializers
{

/// As manipulators of the text formats' streams: from here on so many digits that reading gives the same number. OSG
/// itself writes six.
std::ios_base& exactFloats(std::ios_base& stream);
std::ios_base& exactDoubles(std::ios_base& stream);

/// A serializer that writes no property but has the rest of the file, OSG's own arrays too, written with exact floats.
/// It goes first among those of our drawables and nodes.
class ExactNumbers : public osgDB::BaseSerializer
{
public:
    ExactNumbers() : osgDB::BaseSerializer(READ_WRITE_PROPERTY) {}

    bool read(osgDB::InputStream&, osg::Object&) override { return true; }
    bool write(osgDB::OutputStream& stream, const osg::Object&) override;
    const std::string& getName() const override { return _name; }

private:
    std::string _name = "ExactNumbers";
};

} // namespace osgGpuAnimation::serializers
