// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <osg/Group>
#include <osg/Image>
#include <osg/TextureCubeMap>
#include <osg/Uniform>

#include <string>

namespace osgGpuAnimation
{

class RadianceCube;

/// The surroundings that light everything below the node (image-based light): the materials of PbrMaterial, drawn by
/// the character program or the surface program. They replace the ambient light of OSG's lights; the lights themselves
/// still shine. Without an Environment, the ambient light is an even surrounding.
///
///     const Result<osg::ref_ptr<Environment>> read = Environment::fromFile("sunset.hdr");
///     if (!read) return read.error();
///     const osg::ref_ptr<Environment>& environment = read.value();
///     environment->setIntensity(0.8f);
///     environment->addChild(model);
///
/// The surroundings are in the node's space, +Z up. An inner Environment replaces an outer one. The node does not draw
/// the surroundings themselves.
///
/// Pictures have the pixel formats LUMINANCE, RED, LUMINANCE_ALPHA, RG, RGB, RGBA, BGR or BGRA. Floats (.hdr) and half
/// floats are linear radiance; 8 and 16 bits are sRGB. Components that are negative or not finite count as 0, and those
/// above 65504 as 65504. A set call reads the pixels (0.1 to 1 s); call it again after a change of them. The GPU
/// prefilters them when they are first drawn in a graphics context.
class Environment : public osg::Group
{
public:
    /// The surroundings are the studio.
    Environment();
    /// Shares the pictures and what was made of them, however deep the copy is.
    Environment(const Environment& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGpuAnimation, Environment)

    /// Surroundings of a panorama in the format Radiance HDR, which may be of any origin: this reader is the kit's own.
    /// At most 16384 x 8192 pixels and 1 GiB. For other formats pass osgDB::readRefImageFile() to setPanorama(): OSG's
    /// readers trust their files. file: no search path. Errors start with the name of the file: it does not exist or
    /// is not regular; a fault in it (`row 3: expected …, found …`); the errors of setPanorama().
    static Result<osg::ref_ptr<Environment>> fromFile(const std::string& file);

    /// The studio: a formula without textures, with a gradient from below to above and three soft lights.
    void setStudio();
    /// An equirectangular picture, twice as wide as high. Its middle is in the direction +X, from there -Y lies to the
    /// right; the first row of pixels is below (-Z), the last above (+Z). Errors, which leave the surroundings as they
    /// are: null, no pixels, another shape, another pixel format; the message contains what was found.
    Result<void> setPanorama(osg::Image* panorama);
    /// The six images of a cube map, of one size, as GL samples them (OpenGL 4.6, table 8.19; the first row of a side
    /// face is above) with POSITIVE_Y above: POSITIVE_X is in the direction +X, POSITIVE_Y +Z, POSITIVE_Z -Y. osgDB's
    /// readers put the first row below: turn what they read by osg::Image::flipVertical(). Errors as of a panorama.
    Result<void> setFaces(osg::TextureCubeMap* faces);

    osg::Image* getPanorama() const { return _panorama; }    ///< null: the studio or faces
    osg::TextureCubeMap* getFaces() const { return _faces; } ///< null: the studio or a panorama

    /// Multiplies the radiance; default 1. A number that is negative or not finite counts as 0.
    void setIntensity(float intensity);
    float getIntensity() const { return _intensity; } ///< 0 or more

    /// Turns the surroundings about +Z, counter-clockwise from above; radians; default 0. A number that is
    /// not finite changes nothing.
    void setRotation(float radians);
    float getRotation() const { return _rotation; } ///< radians

    /// Khronos PBR Neutral tone mapping of everything below; default false: colours above 1 are clamped.
    void setToneMapping(bool isOn) { _toneMapping = isOn; }
    bool getToneMapping() const { return _toneMapping; } ///< true: colours above 1 are compressed

    void traverse(osg::NodeVisitor& visitor) override;
    void setThreadSafeRefUnref(bool threadSafe) override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~Environment() override = default;

    const osg::TextureCubeMap* getMap() const { return _map; } ///< prefiltered; null: the studio

private:
    void setPictures(osg::Image* panorama, osg::TextureCubeMap* faces, const RadianceCube& radiance);
    osg::ref_ptr<osg::StateSet> makeLight(const osg::Matrix& nodeToEye) const;

    float _intensity = 1.0f;
    float _rotation = 0.0f; ///< radians
    bool _toneMapping = false;
    osg::ref_ptr<osg::Image> _panorama;
    osg::ref_ptr<osg::TextureCubeMap> _faces;
    osg::ref_ptr<osg::TextureCubeMap> _map;  ///< prefiltered; null: the studio
    osg::ref_ptr<osg::Uniform> _harmonics;   ///< null: the studio
    osg::ref_ptr<osg::Uniform> _intensities; ///< a new one for each value: draw threads use the one before
};

} // namespace osgGpuAnimation
