// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"
#include "ModelReader.h"

#include "cache/SeparateLoads.h"
#include "cache/TypedWriters.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <new>
#include <string>

namespace osgGpuAnimation
{

/// The osgPlugin for glTF 2.0: .gltf and .glb become an animated OSG graph, see gltf::importModel().
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
    ReadResult readObject(std::istream& stream, const Options* options) const override
    {
        return readNode(stream, options);
    }
    ReadResult readNode(std::istream& stream, const Options* options) const override;

protected:
    Result<std::string> readGltf(const std::string& path, const gltf::ImportOptions& options,
                                 gltf::Messages&) const override
    {
        return gltf::readModelFile(path, options);
    }
};

osgDB::ReaderWriter::ReadResult ReaderWriterGltf::readNode(std::istream& stream, const Options* options) const
{
    try
    {
        const Result<gltf::ImportOptions> importOptions = importOptionsOf(options);
        if (!importOptions) return ReadResult(importOptions.error().message);
        const Result<std::string> bytes = gltf::readModelStream(stream, importOptions.value());
        if (!bytes) return ReadResult(bytes.error().message);
        // A stream has no folder; the first database path of the options is the folder of its external files.
        const bool hasFolder = options && !options->getDatabasePathList().empty();
        return import(bytes.value(), hasFolder ? osgDB::concatPaths(options->getDatabasePathList().front(), "") : "",
                      options, importOptions.value(), {});
    }
    catch (const std::bad_alloc&)
    {
        return ReadResult::INSUFFICIENT_MEMORY_TO_LOAD;
    }
}

static SeparateLoads::Installation separateLoads;
static TypedWriters::Installation typedWriters;

} // namespace osgGpuAnimation

using osgGpuAnimation::ReaderWriterGltf;
REGISTER_OSGPLUGIN(gltf, ReaderWriterGltf)
