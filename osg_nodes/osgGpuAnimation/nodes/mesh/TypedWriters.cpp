// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/mesh/PaletteEntryBounds.h>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <iterator>

namespace osgGpuAnimation
{

namespace
{

/// Says so when a scene with characters is written as .osg or .ive. Those writers select nodes by OSG's own types and
/// visit nothing, so they cannot be given posed meshes (see visitPosed()). osgDB asks all ReaderWriters in turn; this
/// one writes nothing itself.
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

const osgDB::RegisterReaderWriterProxy<TypedWriters> typedWriters;

/// A .osgb is read by the plugin that writes .osg, so that one is registered already. osgDB holds the lock of this list
/// while it loads a library.
[[maybe_unused]] const bool isAskedFirst = []
{
    osgDB::Registry::ReaderWriterList& list = osgDB::Registry::instance()->getReaderWriterList();
    std::rotate(list.begin(), std::prev(list.end()), list.end());
    return true;
}();

} // namespace

} // namespace osgGpuAnimation
