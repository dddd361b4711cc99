// SPDX-License-Identifier: MIT
#include "assimp/ConversionProcess.h"
#include "ModelReader.h"
#include "serializers/RegistryHooks.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

namespace osgGpuAnimation
{

/// The osgPlugin for what Assimp reads: `dancer.fbx`. With a pseudo-loader for formats of which OSG has readers, too:
/// `01_01.bvh.assimp` reads `01_01.bvh`. See assimp::readAsGlbApart().
class ReaderWriterAssimp : public ModelReader
{
public:
    ReaderWriterAssimp()
    {
        supportsExtension("assimp", "pseudo-loader: MODEL.assimp, of any format that Assimp reads");
        supportsExtension("fbx", "Autodesk FBX");
        supportsExtension("md5mesh", "Doom 3, with the .md5anim of the same name");
        supportsExtension("smd", "Valve's SMD");
        supportsExtension("b3d", "Blitz3D");
        supportsExtension("ms3d", "Milkshape 3D");
        supportsExtension("ogex", "OpenGEX");
    }

    const char* className() const override { return "osgGpuAnimation reader through Assimp"; }

protected:
    std::string modelFile(const std::string& fileName) const override
    {
        return osgDB::getLowerCaseFileExtension(fileName) == "assimp" ? osgDB::getNameLessExtension(fileName)
                                                                      : fileName;
    }

    Result<std::string> readGltf(const std::string& path, const gltf::ImportOptions& options,
                                 gltf::Messages& messages) const override
    {
        gltf::Report report(messages);
        return assimp::readAsGlbApart(path, options, report);
    }
};

static RegistryHooks registryHooks;

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterAssimp;
REGISTER_OSGPLUGIN(assimp, ReaderWriterAssimp)
