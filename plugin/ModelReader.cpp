// SPDX-License-Identifier: MIT
#include "ModelReader.h"

#include <osg/Notify>
#include <osg/UserDataContainer>
#include <osg/ValueObject>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <new>

namespace osgGpuAnimation
{

namespace
{

Result<std::string> readThroughAssimp(const std::string& path, const gltf::ImportOptions& options, gltf::Report& report)
{
    osgDB::ReaderWriter* const reader = osgDB::Registry::instance()->getReaderWriterForExtension("assimp");
    if (!reader) return Error{"the file is no glTF, and the plugin for other formats, osgdb_assimp, is not installed"};
    const osg::ref_ptr<osgDB::Options> request =
        new osgDB::Options("maxDecodedBytes=" + std::to_string(options.maxDecodedBytes) +
                           " maxNodeDepth=" + std::to_string(options.maxNodeDepth) +
                           (options.allowOutsideFiles ? " allowOutsideFiles" : ""));
    request->setPluginStringData(glbRequest, "1");
    osgDB::ReaderWriter::ReadResult read = reader->readObject(path + ".assimp", request);
    auto* const glb = dynamic_cast<osg::StringValueObject*>(read.getObject());
    if (!glb) return Error{read.message().empty() ? "the plugin osgdb_assimp cannot read it" : read.message()};
    if (const osg::UserDataContainer* const warnings = glb->getUserDataContainer())
        for (const std::string& warning : warnings->getDescriptions())
            report.warn(warning);
    return glb->getValue();
}

} // namespace

gltf::OtherFormats ModelReader::otherFormats() const
{
    return readThroughAssimp;
}

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
    own.otherFormats = otherFormats();
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
