// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"

#include <osg/Texture2D>
#include <tiny_gltf.h>

#include <map>
#include <memory>
#include <string>

namespace osgGpuAnimation::gltf
{

/// One osg::Texture2D for each texture of the file, with its sampler's filters and wrapping (glTF 2.0, section 3.8);
/// textures of one picture share the osg::Image.
///
/// A thread decodes the base colour pictures of all materials while the import reads clips and meshes, because decoding
/// takes a large part of the load. Other pictures are never decoded.
class Textures
{
public:
    Textures(const tinygltf::Model& model, Report& report);
    /// Does not wait for pictures that the thread has not begun.
    ~Textures();

    /// Null for -1, and, with a warning, if the picture is missing or damaged: it is then drawn white.
    osg::Texture2D* texture(int index);

private:
    class Decoding;

    osg::Image* image(int index);
    osg::ref_ptr<osg::Texture2D> make(const tinygltf::Texture& source);

    const tinygltf::Model& _model;
    Report& _report;
    std::unique_ptr<Decoding> _decoding;
    std::map<int, osg::ref_ptr<osg::Texture2D>> _textures;
    std::map<int, osg::ref_ptr<osg::Image>> _images; ///< the requested ones; null if damaged
};

} // namespace osgGpuAnimation::gltf
