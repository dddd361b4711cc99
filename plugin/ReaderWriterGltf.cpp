// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"
#include "gltf/Import.h"
#include "gltf/ImportOptions.h"

#include "cache/SeparateLoads.h"
#include "cache/TypedWriters.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <new>
#include <string>

namespace osgGpuAnimation
{

/// The osgPlugin for glTF 2.0: .gltf and .glb become an animated OSG graph, see gltf::importModel().
/// Errors go into the ReadResult, which osgDB prints; warnings are printed here at WARN, notes at INFO.
class ReaderWriterGltf : public osgDB::ReaderWriter
{
public:
    ReaderWriterGltf()
    {
        supportsExtension("gltf", "glTF 2.0, JSON");
        supportsExtension("glb", "glTF 2.0, binary");
        for (const auto& [name, help] : gltf::optionHelp())
            supportsOption(name, help);
    }

    const char* className() const override { return "osgGpuAnimation glTF 2.0 reader"; }

    ReadResult readObject(const std::string& fileName, const Options* options) const override
    {
        return readNode(fileName, options);
    }
    ReadResult readObject(std::istream& stream, const Options* options) const override
    {
        return readNode(stream, options);
    }
    ReadResult readNode(const std::string& fileName, const Options* options) const override;
    ReadResult readNode(std::istream& stream, const Options* options) const override;

private:
    ReadResult import(const std::string& bytes, const std::string& fileName, const Options* options,
                      const gltf::ImportOptions& importOptions) const;
};

static Result<gltf::ImportOptions> optionsOf(const osgDB::Options* options)
{
    return gltf::parseOptions(options ? options->getOptionString() : "");
}

osgDB::ReaderWriter::ReadResult ReaderWriterGltf::readNode(const std::string& fileName, const Options* options) const
{
    if (!acceptsExtension(osgDB::getLowerCaseFileExtension(fileName))) return ReadResult::FILE_NOT_HANDLED;
    const std::string path = osgDB::findDataFile(fileName, options);
    if (path.empty()) return ReadResult::FILE_NOT_FOUND;
    try
    {
        const Result<gltf::ImportOptions> importOptions = optionsOf(options);
        if (!importOptions) return ReadResult(importOptions.error().message);
        const Result<std::string> bytes = gltf::readModelFile(path, importOptions.value());
        if (!bytes) return ReadResult(bytes.error().message);
        return import(bytes.value(), path, options, importOptions.value());
    }
    catch (const std::bad_alloc&)
    {
        return ReadResult::INSUFFICIENT_MEMORY_TO_LOAD;
    }
}

osgDB::ReaderWriter::ReadResult ReaderWriterGltf::readNode(std::istream& stream, const Options* options) const
{
    try
    {
        const Result<gltf::ImportOptions> importOptions = optionsOf(options);
        if (!importOptions) return ReadResult(importOptions.error().message);
        const Result<std::string> bytes = gltf::readModelStream(stream, importOptions.value());
        if (!bytes) return ReadResult(bytes.error().message);
        // A stream has no folder; the first database path of the options is the folder of its external files.
        const bool hasFolder = options && !options->getDatabasePathList().empty();
        return import(bytes.value(), hasFolder ? osgDB::concatPaths(options->getDatabasePathList().front(), "") : "",
                      options, importOptions.value());
    }
    catch (const std::bad_alloc&)
    {
        return ReadResult::INSUFFICIENT_MEMORY_TO_LOAD;
    }
}

osgDB::ReaderWriter::ReadResult ReaderWriterGltf::import(const std::string& bytes, const std::string& fileName,
                                                         const Options* options,
                                                         const gltf::ImportOptions& importOptions) const
{
    const std::string given = options ? options->getOptionString() : "";
    for (const std::string& hint : gltf::misspeltOptions(given, gltf::optionHelp()))
        OSG_WARN << className() << ": " << hint << std::endl;
    const Result<gltf::ImportedModel> model = gltf::importModel(bytes, fileName, importOptions);
    if (!model) return ReadResult(model.error().message);
    const std::string subject = fileName.empty() ? "glTF stream" : fileName;
    for (const std::string& warning : model.value().messages.warnings)
        OSG_WARN << subject << ": " << warning << std::endl;
    for (const std::string& note : model.value().messages.notes)
        OSG_INFO << subject << ": " << note << std::endl;
    return ReadResult(model.value().root.get());
}

static SeparateLoads::Installation separateLoads;
static TypedWriters::Installation typedWriters;

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterGltf;
REGISTER_OSGPLUGIN(gltf, ReaderWriterGltf)
