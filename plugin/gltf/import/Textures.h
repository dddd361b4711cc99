// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"

#include <osg/Texture2D>
#include <tiny_gltf.h>

#include <map>
#include <memory>
#include <tuple>

namespace osgGpuAnimation::gltf
{

/// The meaning of a picture's numbers, and the texture format that follows from it.
enum class ColorSpace
{
    Display, ///< sampled as stored, for the fixed pipeline; the osg::Image decides the format
    Srgb,    ///< colours in sRGB that GL decodes: GL_SRGB8 or GL_SRGB8_ALPHA8; 16 bits a channel are stored as 8
    Linear   ///< data, sampled as stored: GL_RGB8, GL_RGBA8, GL_RGB16 or GL_RGBA16
};

/// One osg::Texture2D for each picture, sampler and colour space in use, with the sampler's filters and wrapping (glTF
/// 2.0, section 3.8): textures of the file that agree in them share it. Those of one picture share the osg::Image.
///
/// Up to four threads decode the pictures of all materials while the import reads clips and meshes, because decoding
/// takes a large part of the load. Base colours come first.
class Textures
{
public:
    /// Decodes the pictures of the maps that materials show, see MaterialMaps. allMaps: false: only of base colours.
    /// texture() is null for all other pictures. keepsEncoded: see keepEncoded().
    Textures(const tinygltf::Model& model, Report& report, bool allMaps, bool keepsEncoded = false);
    /// Does not wait for pictures whose decoding has not begun.
    ~Textures();

    /// Null for -1, and, with a warning, if the picture is missing or damaged: it is then drawn white.
    osg::Texture2D* texture(int index, ColorSpace space = ColorSpace::Display);

private:
    class Decoding;

    osg::Image* image(int index);
    osg::ref_ptr<osg::Texture2D> make(const tinygltf::Texture& source, ColorSpace space);

    const tinygltf::Model& _model;
    Report& _report;
    const bool _keepsEncoded;
    std::unique_ptr<Decoding> _decoding;
    /// By picture, sampler and colour space.
    std::map<std::tuple<int, int, ColorSpace>, osg::ref_ptr<osg::Texture2D>> _textures;
    std::map<int, osg::ref_ptr<osg::Image>> _images; ///< the requested ones; null if damaged
};

} // namespace osgGpuAnimation::gltf
