// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <osgDB/ReaderWriter>

#include <string>

namespace osgGpuAnimation
{

/// A plugin whose files become glTF and then animated OSG graphs, with the options of gltf::optionHelp(). Errors go
/// into the ReadResult, which osgDB prints; warnings are printed here at WARN, notes at INFO.
class ModelReader : public osgDB::ReaderWriter
{
public:
    ReadResult readObject(const std::string& fileName, const Options* options) const override
    {
        return readNode(fileName, options);
    }
    /// Status INSUFFICIENT_MEMORY_TO_LOAD if std::bad_alloc is thrown.
    ReadResult readNode(const std::string& fileName, const Options* options) const override;

protected:
    ModelReader();

    /// The content of a file as glTF. path: of a file that osgDB found; messages: what the reading has to say.
    virtual Result<std::string> readGltf(const std::string& path, const gltf::ImportOptions& options,
                                         gltf::Messages& messages) const = 0;
    /// The file that a name asks for.
    virtual std::string modelFile(const std::string& fileName) const { return fileName; }

    ReadResult import(const std::string& bytes, const std::string& fileName, const Options* options,
                      const gltf::ImportOptions& importOptions, const gltf::Messages& messages) const;
};

/// The import's choices in osgDB's option string; see gltf::parseOptions().
Result<gltf::ImportOptions> importOptionsOf(const osgDB::Options* options);

} // namespace osgGpuAnimation
