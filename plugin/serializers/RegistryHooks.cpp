// SPDX-License-Identifier: MIT
#include "serializers/RegistryHooks.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <string_view>

namespace osgGpuAnimation
{

namespace
{

class SeparateLoads : public osgDB::ReadFileCallback
{
public:
    using Result = osgDB::ReaderWriter::ReadResult;

    Result readObject(const std::string& file, const osgDB::Options* options) override
    {
        return separated(ReadFileCallback::readObject(file, options), options, osgDB::Options::CACHE_OBJECTS);
    }
    Result readNode(const std::string& file, const osgDB::Options* options) override
    {
        return separated(ReadFileCallback::readNode(file, options), options, osgDB::Options::CACHE_NODES);
    }

private:
    static Result separated(Result read, const osgDB::Options* options, int hint)
    {
        const auto isOwn = [](const osg::Node& each)
        { return dynamic_cast<const AnimatedCharacter*>(&each) || dynamic_cast<const AnimatedCrowd*>(&each); };
        osg::Node* const node = read.getNode();
        if (!node || !options || (options->getObjectCacheHint() & hint) == 0 || !visitUntil(*node, isOwn)) return read;
        return Result(osg::clone(node, osg::CopyOp::DEEP_COPY_NODES), read.status());
    }
};

class TypedWriters : public osgDB::ReaderWriter
{
public:
    const char* className() const override { return "osgGpuAnimation message about .osg and .ive"; }
    bool acceptsExtension(const std::string&) const override { return false; }
    WriteResult writeNode(const osg::Node& node, const std::string& fileName, const Options*) const override
    {
        const std::string extension = osgDB::getLowerCaseFileExtension(fileName);
        if (extension != "osg" && extension != "osgs" && extension != "ive") return WriteResult::FILE_NOT_HANDLED;
        bool hasMesh = false;
        forEachMeshBelow(const_cast<osg::Node&>(node), [&](const SkinnedGeometry&) { hasMesh = true; });
        if (hasMesh)
            OSG_WARN << "osgGpuAnimation: ." << extension
                     << " cannot store characters and leaves them out. Write .osgb, .osgt or .osgx, which store the "
                        "animation, or a mesh format such as .obj, which stores the present pose"
                     << std::endl;
        return WriteResult::FILE_NOT_HANDLED;
    }
};

} // namespace

RegistryHooks::RegistryHooks()
{
    osgDB::Registry* const registry = osgDB::Registry::instance();
    if (!registry) return;
    if (!registry->getReadFileCallback()) registry->setReadFileCallback(_separateLoads = new SeparateLoads);
    // A .osgb is read by the plugin that writes .osg, so that one is registered before and must come second. osgDB
    // holds the lock of its list while it loads a plugin.
    const osg::ref_ptr<TypedWriters> writers = new TypedWriters;
    osgDB::Registry::ReaderWriterList& list = registry->getReaderWriterList();
    for (const osg::ref_ptr<osgDB::ReaderWriter>& known : list)
        if (std::string_view(known->className()) == writers->className()) return;
    _typedWriters = *list.insert(list.begin(), writers);
}

RegistryHooks::~RegistryHooks()
{
    osgDB::Registry* const registry = osgDB::Registry::instance();
    if (!registry) return;
    if (_separateLoads && registry->getReadFileCallback() == _separateLoads) registry->setReadFileCallback(nullptr);
    if (_typedWriters) registry->removeReaderWriter(_typedWriters);
}

} // namespace osgGpuAnimation
