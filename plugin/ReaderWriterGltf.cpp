// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "gltf/OptionString.h"
#include "gltf/RegularFile.h"

#include "cache/SeparateLoads.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <istream>
#include <new>
#include <optional>
#include <string>

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t mostBytesOfAStream = std::size_t(2) << 30;

/// All of the stream; nothing where it fails or holds more than the limit.
std::optional<std::string> readAll(std::istream& stream, std::size_t limit)
{
    std::string bytes;
    char block[65536];
    while (stream.read(block, sizeof(block)) || stream.gcount() > 0)
    {
        bytes.append(block, static_cast<std::size_t>(stream.gcount()));
        if (bytes.size() > limit) return std::nullopt;
    }
    if (stream.bad()) return std::nullopt;
    return bytes;
}

/// osgDB puts the file's name in front of a message.
std::string withoutSubject(const std::string& message, const std::string& path)
{
    const std::string subject = path + ": ";
    return message.rfind(subject, 0) == 0 ? message.substr(subject.size()) : message;
}

} // namespace

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
    ReadResult import(const std::string& bytes, const std::string& fileName, const Options* options) const;
};

osgDB::ReaderWriter::ReadResult ReaderWriterGltf::readNode(const std::string& fileName, const Options* options) const
{
    if (!acceptsExtension(osgDB::getLowerCaseFileExtension(fileName))) return ReadResult::FILE_NOT_HANDLED;
    const std::string path = osgDB::findDataFile(fileName, options);
    if (path.empty()) return ReadResult::FILE_NOT_FOUND;
    try
    {
        const Result<std::string> bytes = gltf::readWholeFile(path);
        if (!bytes) return ReadResult(withoutSubject(bytes.error().message, path));
        return import(bytes.value(), path, options);
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
        const std::optional<std::string> bytes = readAll(stream, mostBytesOfAStream);
        if (!bytes) return ReadResult("the stream cannot be read, or does not end");
        // A stream has no folder of its own; external files are found in the folder that the options put first.
        const bool hasFolder = options && !options->getDatabasePathList().empty();
        return import(*bytes, hasFolder ? osgDB::concatPaths(options->getDatabasePathList().front(), "stream") : "",
                      options);
    }
    catch (const std::bad_alloc&)
    {
        return ReadResult::INSUFFICIENT_MEMORY_TO_LOAD;
    }
}

osgDB::ReaderWriter::ReadResult ReaderWriterGltf::import(const std::string& bytes, const std::string& fileName,
                                                         const Options* options) const
{
    const Result<gltf::ImportOptions> importOptions = gltf::parseOptions(options ? options->getOptionString() : "");
    if (!importOptions) return ReadResult(importOptions.error().message);
    for (const std::string& hint : gltf::misspeltOptions(options ? options->getOptionString() : ""))
        OSG_WARN << className() << ": " << hint << std::endl;
    const Result<gltf::ImportedModel> model = gltf::importModel(bytes, fileName, importOptions.value());
    if (!model) return ReadResult(model.error().message);
    const std::string subject = fileName.empty() ? "glTF stream" : fileName;
    for (const std::string& warning : model.value().messages.warnings)
        OSG_WARN << subject << ": " << warning << std::endl;
    for (const std::string& note : model.value().messages.notes)
        OSG_INFO << subject << ": " << note << std::endl;
    return ReadResult(model.value().root.get());
}

static SeparateLoads::Installation separateLoads;

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterGltf;
REGISTER_OSGPLUGIN(gltf, ReaderWriterGltf)
