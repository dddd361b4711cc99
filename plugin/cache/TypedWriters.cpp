// SPDX-License-Identifier: MIT
#include "cache/TypedWriters.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <string_view>

namespace osgGpuAnimation
{

// A .osgb is read by the plugin that writes .osg, so that one is registered before and must come second. osgDB holds
// the lock of its list while it loads a plugin.
TypedWriters::Installation::Installation()
{
    osgDB::Registry* registry = osgDB::Registry::instance();
    if (!registry) return;
    const osg::ref_ptr<TypedWriters> writer = new TypedWriters;
    osgDB::Registry::ReaderWriterList& list = registry->getReaderWriterList();
    for (const osg::ref_ptr<osgDB::ReaderWriter>& known : list)
        if (std::string_view(known->className()) == writer->className()) return;
    list.insert(list.begin(), writer);
    _writer = writer;
}

TypedWriters::Installation::~Installation()
{
    osgDB::Registry* registry = osgDB::Registry::instance();
    if (registry && _writer) registry->removeReaderWriter(_writer);
}

osgDB::ReaderWriter::WriteResult TypedWriters::writeNode(const osg::Node& node, const std::string& fileName,
                                                         const Options*) const
{
    const std::string extension = osgDB::getLowerCaseFileExtension(fileName);
    if (extension != "osg" && extension != "osgs" && extension != "ive") return WriteResult::FILE_NOT_HANDLED;
    bool hasMesh = false;
    forEachMeshBelow(const_cast<osg::Node&>(node), [&](const SkinnedGeometry&) { hasMesh = true; });
    if (hasMesh)
        OSG_WARN
            << "osgGpuAnimation: ." << extension
            << " cannot store characters and leaves them out. Write .osgb, .osgt or .osgx, which store the animation, "
               "or a mesh format such as .obj, which stores the present pose"
            << std::endl;
    return WriteResult::FILE_NOT_HANDLED;
}

} // namespace osgGpuAnimation
