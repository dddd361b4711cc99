// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GlbWriter.h"
#include "gltf/file/Report.h"
#include "gltf/file/Uri.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>

struct aiScene;

namespace osgGpuAnimation::assimp
{

/// The pictures of a scene, embedded ones and files, each written once.
class Pictures
{
public:
    /// modelFile: see glbOf().
    Pictures(const aiScene& scene, const std::string& modelFile, gltf::GlbWriter& writer, gltf::Report& report);

    /// The index of the glTF image for a path as materials have it: `*0`, or a file's. None, with a warning, if it is
    /// not there or not a picture that can be read.
    std::optional<std::size_t> imageOf(const std::string& path);

private:
    std::optional<std::size_t> write(const std::string& path);
    Result<std::string> bytesOf(const std::string& path) const;
    Result<std::string> fileBytes(std::string path) const;

    const aiScene& _scene;
    std::string _modelName; ///< without folder and extension
    gltf::ModelFolder _folder;
    gltf::GlbWriter& _writer;
    gltf::Report& _report;
    std::map<std::string, std::optional<std::size_t>> _images;
};

} // namespace osgGpuAnimation::assimp
