// SPDX-License-Identifier: MIT
#include "gltf/Export.h"
#include "gltf/file/ModelBytes.h"
#include "gltf/file/SavedFile.h"
#include "ModelReader.h"
#include "serializers/RegistryHooks.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <new>
#include <string>

namespace osgGpuAnimation
{

/// The osgPlugin for glTF 2.0: .gltf and .glb become an animated OSG graph, see gltf::importModel(), and scenes become
/// .glb, see gltf::exportModel().
class ReaderWriterGltf : public ModelReader
{
public:
    ReaderWriterGltf()
    {
        supportsExtension("gltf", "glTF 2.0, JSON");
        supportsExtension("glb", "glTF 2.0, binary");
    }

    const char* className() const override { return "osgGpuAnimation glTF 2.0 reader"; }

    using ModelReader::readNode;
    using ModelReader::readObject;
    using ModelReader::writeNode;
    using ModelReader::writeObject;
    ReadResult readObject(std::istream& stream, const Options* options) const override
    {
        return readNode(stream, options);
    }
    ReadResult readNode(std::istream& stream, const Options* options) const override
    {
        // A stream has no folder; the first database path of the options is the folder of its external files.
        const bool hasFolder = options && !options->getDatabasePathList().empty();
        return import(hasFolder ? osgDB::concatPaths(options->getDatabasePathList().front(), "") : "", options,
                      [&](const gltf::ImportOptions& importOptions, gltf::Messages&)
                      { return gltf::readModelStream(stream, importOptions); });
    }

    WriteResult writeObject(const osg::Object& object, const std::string& fileName,
                            const Options* options) const override
    {
        const auto* const node = dynamic_cast<const osg::Node*>(&object);
        return node ? writeNode(*node, fileName, options) : WriteResult(WriteResult::FILE_NOT_HANDLED);
    }
    WriteResult writeNode(const osg::Node& node, const std::string& fileName, const Options*) const override
    {
        return write(node, fileName, [&](const std::string& bytes) { return gltf::saveFile(fileName, bytes); });
    }
    WriteResult writeNode(const osg::Node& node, std::ostream& stream, const Options*) const override
    {
        const auto save = [&](const std::string& bytes) -> Result<void>
        {
            if (stream << bytes << std::flush) return {};
            return Error{"the stream cannot be written"};
        };
        return write(node, "scene.glb", save);
    }

protected:
    Result<std::string> readGltf(const std::string& path, const gltf::ImportOptions& options,
                                 gltf::Messages&) const override
    {
        return gltf::readModelFile(path, options);
    }

private:
    /// save: called with the bytes of the file.
    template <typename Save>
    WriteResult write(const osg::Node& node, const std::string& fileName, Save save) const
    {
        const std::string extension = osgDB::getLowerCaseFileExtension(fileName);
        if (!acceptsExtension(extension)) return WriteResult::FILE_NOT_HANDLED;
        if (extension == "gltf") return WriteResult("glTF is written as .glb only");
        try
        {
            gltf::Messages messages;
            gltf::Report report(messages);
            const Result<std::string> bytes = gltf::exportModel(node, report);
            for (const std::string& warning : messages.warnings)
                OSG_WARN << fileName << ": " << warning << std::endl;
            if (!bytes) return WriteResult(bytes.error().message);
            const Result<void> saved = save(bytes.value());
            return saved ? WriteResult(WriteResult::FILE_SAVED) : WriteResult(saved.error().message);
        }
        catch (const std::bad_alloc&)
        {
            return WriteResult("not enough memory");
        }
    }
};

static RegistryHooks registryHooks;

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterGltf;
REGISTER_OSGPLUGIN(gltf, ReaderWriterGltf)
