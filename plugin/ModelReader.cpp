// SPDX-License-Identifier: MIT
#include "ModelReader.h"

#ifdef OSGGPUANIMATION_ASSIMP
#include "assimp/ConversionProcess.h"
#endif

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>

#include <new>

namespace osgGpuAnimation
{

Result<gltf::ImportOptions> importOptionsOf(const osgDB::Options* options)
{
    return gltf::parseOptions(options ? options->getOptionString() : "");
}

ModelReader::ModelReader()
{
    for (const auto& [name, help] : gltf::optionHelp())
        supportsOption(name, help);
}

osgDB::ReaderWriter::ReadResult ModelReader::readNode(const std::string& fileName, const Options* options) const
{
    if (!acceptsExtension(osgDB::getLowerCaseFileExtension(fileName))) return ReadResult::FILE_NOT_HANDLED;
    const std::string path = osgDB::findDataFile(modelFile(fileName), options);
    if (path.empty()) return ReadResult::FILE_NOT_FOUND;
    try
    {
        const Result<gltf::ImportOptions> importOptions = importOptionsOf(options);
        if (!importOptions) return ReadResult(importOptions.error().message);
        gltf::Messages messages;
        const Result<std::string> bytes = readGltf(path, importOptions.value(), messages);
        if (!bytes) return ReadResult(bytes.error().message);
        return import(bytes.value(), path, options, importOptions.value(), messages);
    }
    catch (const std::bad_alloc&)
    {
        return ReadResult::INSUFFICIENT_MEMORY_TO_LOAD;
    }
}

osgDB::ReaderWriter::ReadResult ModelReader::import(const std::string& bytes, const std::string& fileName,
                                                    const Options* options, const gltf::ImportOptions& importOptions,
                                                    const gltf::Messages& messages) const
{
    const std::string given = options ? options->getOptionString() : "";
    for (const std::string& hint : gltf::misspeltOptions(given, gltf::optionHelp()))
        OSG_WARN << className() << ": " << hint << std::endl;
    gltf::ImportOptions own = importOptions;
#ifdef OSGGPUANIMATION_ASSIMP
    own.otherFormats = assimp::readAsGlbApart;
#endif
    const Result<gltf::ImportedModel> model = gltf::importModel(bytes, fileName, own);
    if (!model) return ReadResult(model.error().message);
    const std::string subject = fileName.empty() ? "glTF stream" : fileName;
    for (const gltf::Messages* each : {&messages, &model.value().messages})
    {
        for (const std::string& warning : each->warnings)
            OSG_WARN << subject << ": " << warning << std::endl;
        for (const std::string& note : each->notes)
            OSG_INFO << subject << ": " << note << std::endl;
    }
    return ReadResult(model.value().root.get());
}

} // namespace osgGpuAnimation
