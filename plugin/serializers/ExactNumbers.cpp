// SPDX-License-Identifier: MIT
#include "serializers/ExactNumbers.h"

#include "serializers/DefinesInXml.h"

#include <osgDB/OutputStream>

#include <limits>

namespace osgGpuAnimation::serializers
{

std::ios_base& exactFloats(std::ios_base& stream)
{
    stream.precision(std::numeric_limits<float>::max_digits10);
    return stream;
}

std::ios_base& exactDoubles(std::ios_base& stream)
{
    stream.precision(std::numeric_limits<double>::max_digits10);
    return stream;
}

bool ExactNumbers::write(osgDB::OutputStream& stream, const osg::Object&)
{
    repairDefinesInXml();
    if (!stream.isBinary()) stream << &exactFloats;
    return true;
}

// Named first by the other wrappers; no object is of this class.
REGISTER_OBJECT_WRAPPER2(osgGpuAnimation_ExactNumbers, nullptr, ExactNumbers, "osgGpuAnimation::ExactNumbers",
                         "osgGpuAnimation::ExactNumbers")
{
    wrapper->addSerializer(new ExactNumbers, osgDB::BaseSerializer::RW_USER);
}

} // namespace osgGpuAnimation::serializers
