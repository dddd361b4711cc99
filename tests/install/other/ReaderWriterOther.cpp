// SPDX-License-Identifier: MIT
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

/// A third-party osgdb_gltf, such as osgEarth's: it takes the same extensions, and its message names it.
class ReaderWriterOther : public osgDB::ReaderWriter
{
public:
    ReaderWriterOther()
    {
        supportsExtension("gltf", "somebody else's");
        supportsExtension("glb", "somebody else's");
    }

    const char* className() const override { return "another glTF reader"; }

    ReadResult readObject(const std::string& fileName, const Options* options) const override
    {
        return readNode(fileName, options);
    }

    ReadResult readNode(const std::string& fileName, const Options*) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(fileName))) return ReadResult::FILE_NOT_HANDLED;
        return ReadResult("another plugin was asked");
    }
};

REGISTER_OSGPLUGIN(gltf, ReaderWriterOther)
