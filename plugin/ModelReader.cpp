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
    return import(path, options,
                  [&](const gltf::ImportOptions& importOptions, gltf::Messages& messages)
                  { return readGltf(path, importOptions, messages); });
}

osgDB::ReaderWriter::ReadResult ModelReader::import(const std::string& fileName, const Options* options,
                                                    const Read& read) const
{
    try
    {
        const std::string given = options ? options->getOptionString() : "";
        const Result<gltf::ImportOptions> parsed = gltf::parseOptions(given);
        if (!parsed) return ReadResult(parsed.error().message);
        gltf::ImportOptions own = parsed.value();
        gltf::Messages messages, failed;
        const auto print = [subject = fileName.empty() ? "glTF stream" : fileName](const gltf::Messages& each)
        {
            for (const std::string& warning : each.warnings)
                OSG_WARN << subject << ": " << warning << std::endl;
            for (const std::string& note : each.notes)
                OSG_INFO << subject << ": " << note << std::endl;
        };
        const Result<std::string> bytes = read(own, messages);
        print(messages);
        if (!bytes) return ReadResult(bytes.error().message);
        for (const std::string& hint : gltf::misspeltOptions(given, gltf::optionHelp()))
            OSG_WARN << className() << ": " << hint << std::endl;
#ifdef OSGGPUANIMATION_ASSIMP
        own.otherFormats = assimp::readAsGlbApart;
#endif
        const Result<gltf::ImportedModel> model = gltf::importModel(bytes.value(), fileName, own, &failed);
        print(model ? model.value().messages : failed);
        return model ? ReadResult(model.value().root.get()) : ReadResult(model.error().message);
    }
    catch (const std::bad_alloc&)
    {
        return ReadResult::INSUFFICIENT_MEMORY_TO_LOAD;
    }
}

} // namespace osgGpuAnimation
