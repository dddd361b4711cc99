// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/RegularFile.h"

#include <osgGpuAnimation/animation/Result.h>

#include <string>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// Where the external files of a model may lie: its own folder and below, after symbolic links are resolved, unless the
/// caller allows more. A model that came from a stream has no folder and no external files.
class ModelFolder
{
public:
    /// modelFile: may be empty (a stream).
    ModelFolder(std::string modelFile, bool allowOutsideFiles);

    /// Opens the file of a URI that is no data URI. Errors are `expected …, found …` or name the file.
    Result<RegularFile> open(std::string_view uri) const;

private:
    Result<std::string> resolve(const std::string& path) const;

    std::string _modelFile;
    bool _allowOutsideFiles;
};

} // namespace osgGpuAnimation::gltf
