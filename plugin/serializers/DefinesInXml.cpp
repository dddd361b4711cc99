// SPDX-License-Identifier: MIT
#include "serializers/DefinesInXml.h"

#include <osg/StateSet>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>
#include <osgDB/Registry>

#include <mutex>

namespace osgGpuAnimation::serializers
{

namespace
{

using StateSetSerializer = osgDB::UserSerializer<osg::StateSet>;

StateSetSerializer::Writer writeBinary = nullptr; ///< OSG's own

/// The words that OSG's reader makes the value of.
std::string wordsFor(osg::StateAttribute::OverrideValue value)
{
    std::string words = value & osg::StateAttribute::ON ? "ON" : "OFF";
    if (value & osg::StateAttribute::OVERRIDE) words += "|OVERRIDE";
    if (value & osg::StateAttribute::PROTECTED) words += "|PROTECTED";
    if (value & osg::StateAttribute::INHERIT) words += "|INHERIT";
    return words;
}

bool writeDefines(osgDB::OutputStream& stream, const osg::StateSet& state)
{
    if (stream.isBinary()) return writeBinary(stream, state);
    stream.writeSize(state.getDefineList().size());
    stream << stream.BEGIN_BRACKET << std::endl;
    for (const auto& [name, value] : state.getDefineList())
    {
        stream.writeWrappedString(name);
        stream.writeWrappedString(value.first);
        // As a word: a property in the midst of a line is what gets lost.
        stream << std::string("Value") << wordsFor(value.second) << std::endl;
    }
    stream << stream.END_BRACKET << std::endl;
    return true;
}

void replaceWriter()
{
    osgDB::ObjectWrapper* wrapper =
        osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper("osg::StateSet");
    auto* defines = wrapper ? dynamic_cast<StateSetSerializer*>(wrapper->getSerializer("DefineList")) : nullptr;
    if (!defines) return;
    writeBinary = defines->_writer;
    defines->_writer = writeDefines;
}

} // namespace

void repairDefinesInXml()
{
    static std::once_flag repaired;
    std::call_once(repaired, replaceWriter);
}

} // namespace osgGpuAnimation::serializers
