// SPDX-License-Identifier: MIT
#include <osg/StateSet>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>
#include <osgDB/Registry>

#include <limits>
#include <mutex>

// Two things that scenes of ours need from OSG's text formats, where OSG 3.6.5 loses digits and shader defines.

namespace osgGpuAnimation::serializers
{

namespace
{

using StateSetSerializer = osgDB::UserSerializer<osg::StateSet>;

StateSetSerializer::Writer writeBinary = nullptr; ///< OSG's own

/// The words from which OSG's reader makes the value.
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
        // As a word: OSG drops a property in the middle of a line.
        stream << std::string("Value") << wordsFor(value.second) << std::endl;
    }
    stream << stream.END_BRACKET << std::endl;
    return true;
}

/// Makes osg::StateSet's wrapper write shader defines into an .osgx so that OSG can read them again. OSG omits a word
/// there and then misreads everything after it. The .osgb and .osgt files stay as they are.
void repairDefinesInXml()
{
    osgDB::ObjectWrapper* wrapper =
        osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper("osg::StateSet");
    auto* defines = wrapper ? dynamic_cast<StateSetSerializer*>(wrapper->getSerializer("DefineList")) : nullptr;
    if (!defines) return;
    writeBinary = defines->_writer;
    defines->_writer = writeDefines;
}

std::ios_base& useExactFloats(std::ios_base& stream)
{
    stream.precision(std::numeric_limits<float>::max_digits10);
    return stream;
}

/// Writes no property: the rest of the file, with OSG's own arrays, gets all digits of its floats. OSG writes six.
/// The wrappers of our drawables and nodes name it first.
class ExactNumbers : public osgDB::BaseSerializer
{
public:
    ExactNumbers() : osgDB::BaseSerializer(READ_WRITE_PROPERTY) {}

    bool read(osgDB::InputStream&, osg::Object&) override { return true; }
    bool write(osgDB::OutputStream& stream, const osg::Object&) override
    {
        static std::once_flag repaired;
        std::call_once(repaired, repairDefinesInXml);
        if (!stream.isBinary()) stream << &useExactFloats;
        return true;
    }
    const std::string& getName() const override { return _name; }

private:
    std::string _name = "ExactNumbers";
};

osgDB::RegisterWrapperProxy exactNumbers(nullptr, "osgGpuAnimation::ExactNumbers", "osgGpuAnimation::ExactNumbers",
                                         [](osgDB::ObjectWrapper* wrapper)
                                         { wrapper->addSerializer(new ExactNumbers, osgDB::BaseSerializer::RW_USER); });

} // namespace

} // namespace osgGpuAnimation::serializers
