// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"
#include "gltf/ImageQueue.h"
#include "gltf/Report.h"

#include <osg/Texture2D>
#include <tiny_gltf.h>

#include <map>
#include <memory>
#include <set>
#include <string>

namespace osgGpuAnimation::gltf
{

/// One osg::Texture2D for each texture of the file, with its sampler's filters and wrapping (glTF 2.0, section 3.8);
/// textures of one picture share the osg::Image. The base colour pictures of all materials begin to be decoded at once,
/// in the background; others never are.
class Textures
{
public:
    Textures(const tinygltf::Model& model, DecodedBytes& budget, Report& report);

    /// Null, with a warning, where the picture is missing or damaged: it then counts as white.
    osg::Texture2D* texture(int index);

private:
    osg::Image* image(int index);
    osg::ref_ptr<osg::Texture2D> make(const tinygltf::Texture& source);
    void warn(int image, const std::string& why);

    const tinygltf::Model& _model;
    Report& _report;
    std::unique_ptr<ImageQueue> _queue;
    std::map<int, osg::ref_ptr<osg::Texture2D>> _textures;
    std::map<int, osg::ref_ptr<osg::Image>> _images; ///< decoded
    std::set<int> _pending;                          ///< still in the queue
};

} // namespace osgGpuAnimation::gltf
