// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/ReaderWriter>

#include <string>

namespace osgGpuAnimation
{

/// A plugin whose file names contain the name of a model's file: `fox.glb.studio` is `fox.glb` with the plugin's
/// extension. The plugin of the model's extension reads the model.
class PseudoLoader : public osgDB::ReaderWriter
{
public:
    ReadResult readObject(const std::string& fileName, const Options* options) const override
    {
        return readNode(fileName, options);
    }
    /// Status INSUFFICIENT_MEMORY_TO_LOAD if std::bad_alloc is thrown.
    ReadResult readNode(const std::string& fileName, const Options* options) const override;

protected:
    /// name: the file's, without the plugin's extension.
    virtual ReadResult read(const std::string& name, const Options* options) const = 0;

    /// The model, or an error with the reason of its reader. owner: what the model is for, as "crowd".
    static ReadResult readModel(const std::string& modelFile, const Options* options, const std::string& owner);
};

} // namespace osgGpuAnimation
