// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <osgDB/ReaderWriter>

#include <functional>
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

    using Read = std::function<Result<std::string>(const gltf::ImportOptions&, gltf::Messages&)>;
    /// Imports what `read` gives. fileName: of messages and external files; empty: a stream without a folder.
    ReadResult import(const std::string& fileName, const Options* options, const Read& read) const;
};

} // namespace osgGpuAnimation
