// SPDX-License-Identifier: MIT
#include "tool/ModelFile.h"

#ifdef OSGGPUANIMATION_ASSIMP
#include "assimp/AssimpFile.h"
#include "assimp/ConversionProcess.h"
#endif
#include "gltf/Export.h"
#include "gltf/file/ModelBytes.h"

#include <osgGpuAnimation/math/detail/RegularFile.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <filesystem>
#include <iostream>
#include <utility>

namespace osgGpuAnimation::tool
{

namespace
{

#ifdef OSGGPUANIMATION_ASSIMP
const char* const otherFormats = "";
#else
const char* const otherFormats = " (others need Assimp, without which this osgGpuAnimation was built)";
#endif

bool isCalledGltf(const std::string& fileName)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(fileName);
    return extension == "gltf" || extension == "glb";
}

/// True if a plugin of OSG may read it: by its extension, as osgDB does, pseudo-loaders included.
bool isSceneFormat(const std::string& fileName)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(fileName);
    return !isModelFormat(fileName) && !extension.empty() &&
           osgDB::Registry::instance()->getReaderWriterForExtension(extension);
}

/// The file as glTF; of another format where Assimp or OSG reads it.
Result<std::string> readGltf(const std::string& fileName, const gltf::ImportOptions& options, gltf::Messages& messages)
{
    gltf::Report report(messages);
#ifdef OSGGPUANIMATION_ASSIMP
    if (!isCalledGltf(fileName) && assimp::isFormat(osgDB::getLowerCaseFileExtension(fileName)))
        return assimp::readAsGlbApart(fileName, options, report);
#endif
    if (!isSceneFormat(fileName)) return gltf::readModelFile(fileName, options);
    const Result<osg::ref_ptr<osg::Node>> scene = readScene(fileName, report);
    if (!scene) return scene.error();
    return exportScene(*scene.value(), fileName, report);
}

/// messages: takes those of the file, also before an error.
Result<gltf::ImportedModel> importFile(const std::string& fileName, const gltf::ImportOptions& options,
                                       gltf::Messages& messages)
{
    const Result<std::string> bytes = readGltf(fileName, options, messages);
    if (!bytes) return bytes.error();
    gltf::Messages ofFailure;
    Result<gltf::ImportedModel> imported = gltf::importModel(bytes.value(), fileName, options, &ofFailure);
    const gltf::Messages& own = imported ? imported.value().messages : ofFailure;
    messages.warnings.insert(messages.warnings.end(), own.warnings.begin(), own.warnings.end());
    messages.notes.insert(messages.notes.end(), own.notes.begin(), own.notes.end());
    if (!imported && !isCalledGltf(fileName))
        return Error{std::string("the file is neither .gltf nor .glb") + otherFormats + ": " +
                     imported.error().message};
    if (!imported) return imported;
    if (!own.unmet.empty()) return Error{own.unmet.front()};
    gltf::ImportedModel model = std::move(imported).value();
    model.messages = messages;
    return model;
}

/// True for a file's name, and for one that a pseudo-loader takes: a file's name and more extensions.
bool beginsWithFile(std::string name)
{
    std::string longer;
    std::error_code failure;
    while (!std::filesystem::exists(name, failure) && name != longer)
        longer = std::exchange(name, osgDB::getNameLessExtension(name));
    return name != longer;
}

/// Names for OSG's pseudo-loaders are no files: `fox.glb.studio` shows `fox.glb`.
Error noSuchFile(const std::string& fileName)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(fileName);
    const std::string shown = osgDB::getNameLessExtension(fileName);
    if (extension == "studio")
        return Error{".studio is for OSG's viewers; `osggpuanim render " + shown + "` draws in the studio's light"};
    if (extension == "crowd")
        return Error{".crowd is for `osggpuanim render` and OSG's viewers; name the model's own file, " +
                     osgDB::getNameLessExtension(shown)};
    if (extension == "gpuanim")
        return Error{
            "OSG's plugin for .gpuanim is not found: is osgdb_gpuanim in the library path (OSG_LIBRARY_PATH)?"};
    return Error{"there is no such file"};
}

/// For messages: what a stored scene may lack.
std::string missingSerializers(const std::string& fileName)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(fileName);
    const std::string library =
        osgDB::Registry::instance()->createLibraryNameForExtension("serializers_osggpuanimation");
    if (extension != "osgb" && extension != "osgt" && extension != "osgx") return "";
    if (std::filesystem::exists(osgDB::findLibraryFile(library))) return "";
    return "; characters need osgdb_serializers_osggpuanimation in the library path (OSG_LIBRARY_PATH)";
}

} // namespace

Result<gltf::ImportOptions> importOptions(const ModelArguments& arguments)
{
    gltf::ImportOptions options;
    options.allowOutsideClips = true;
    options.clipMatch = arguments.clipMatch;
    if (arguments.compact > 0.0) options.compact = arguments.compact;
#ifdef OSGGPUANIMATION_ASSIMP
    options.otherFormats = assimp::readAsGlbApart;
#endif
    std::error_code failure;
    for (const std::string& file : arguments.clips)
    {
        options.clipsFiles.push_back(std::filesystem::canonical(file, failure).string());
        if (failure) return Error{file + ": there is no such file"};
    }
    if (arguments.clipJoints.empty()) return options;
    options.clipJoints = std::filesystem::canonical(arguments.clipJoints, failure).string();
    if (failure) return Error{arguments.clipJoints + ": there is no such file"};
    return options;
}

void printWarnings(const std::string& file, const gltf::Messages& messages, const std::string& error)
{
    for (const std::string& warning : messages.warnings)
        if (error.empty() || warning.rfind(error, 0) != 0)
            std::cerr << "osggpuanim: " << file << ": " << warning << std::endl;
}

void printClipWarnings(const std::string& file, const gltf::Messages& messages)
{
    gltf::Messages ofClips;
    for (const std::string& warning : messages.warnings)
        if (warning.rfind("clips ", 0) == 0 || warning.rfind("clipJoints ", 0) == 0)
            ofClips.warnings.push_back(warning);
    printWarnings(file, ofClips);
}

bool isModelFormat(const std::string& fileName)
{
#ifdef OSGGPUANIMATION_ASSIMP
    if (assimp::isFormat(osgDB::getLowerCaseFileExtension(fileName))) return true;
#endif
    return isCalledGltf(fileName);
}

Result<osg::ref_ptr<osg::Node>> readScene(const std::string& fileName, gltf::Report& report)
{
    // readRefNodeFile() would print an error of its own.
    osgDB::ReaderWriter::ReadResult read = osgDB::Registry::instance()->readNode(fileName, nullptr);
    if (read.status() == osgDB::ReaderWriter::ReadResult::FILE_NOT_FOUND) return noSuchFile(fileName);
    const osg::ref_ptr<osg::Node> scene = read.getNode();
    if (!scene && read.message().empty() && !beginsWithFile(fileName)) return noSuchFile(fileName);
    if (!scene)
        return Error{"OSG cannot read it" + (read.message().empty() ? "" : ": " + read.message()) +
                     missingSerializers(fileName)};
    const auto isSkeleton = [](const osg::Node& node) // by name: the tool does not link osgAnimation
    { return std::string(node.libraryName()) == "osgAnimation" && std::string(node.className()) == "Skeleton"; };
    if (visitUntil(*scene, isSkeleton) && osgDB::getLowerCaseFileExtension(fileName) != "gpuanim")
        report.warn("its characters of osgAnimation keep their pose; " + osgDB::getSimpleFileName(fileName) +
                    ".gpuanim has their clips");
    return scene;
}

Result<std::string> exportScene(const osg::Node& scene, const std::string& fileName, gltf::Report& report)
{
    const Result<std::string> bytes = gltf::exportModel(scene, report);
    return bytes ? bytes : Error{bytes.error().message + missingSerializers(fileName)};
}

Result<gltf::ImportedModel> readModel(const std::string& fileName, const gltf::ImportOptions& options)
{
    // Where there is no such file, the name may be one for a pseudo-loader.
    std::error_code failure;
    const bool isThere = std::filesystem::exists(fileName, failure);
    if (!isThere && (osgDB::getLowerCaseFileExtension(fileName) == "studio" || !isSceneFormat(fileName)))
        return noSuchFile(fileName);
    if (isThere)
        if (const Result<RegularFile> file = RegularFile::open(fileName); !file) return file.error();

    gltf::Messages messages;
    const Result<gltf::ImportedModel> model = importFile(fileName, options, messages);
    if (!model) printWarnings(fileName, messages, model.error().message);
    return model;
}

} // namespace osgGpuAnimation::tool
