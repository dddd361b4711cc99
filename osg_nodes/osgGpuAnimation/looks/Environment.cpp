// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/Environment.h>

#include <osgGpuAnimation/looks/environment/HdrPicture.h>
#include <osgGpuAnimation/looks/environment/PrefilteredMap.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <layout.glsl>

#include <osg/Matrix>
#include <osgUtil/CullVisitor>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// From eye space to glTF's axes (+Y up) of the surroundings. A node that mirrors mirrors the surroundings.
osg::Matrix3 environmentFromEye(const osg::Matrix& nodeToEye, float rotation)
{
    osg::Matrix turn = rotationOf(nodeToEye);
    if (glm::determinant(glm::dmat3(glm::make_mat4(nodeToEye.ptr()))) < 0.0) turn.preMultScale(osg::Vec3d(-1, 1, 1));
    const osg::Matrix yUp(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
    const osg::Matrix all = osg::Matrix::inverse(turn) * osg::Matrix::rotate(-rotation, osg::Vec3(0, 0, 1)) * yUp;
    osg::Matrix3 result;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            result(row, column) = static_cast<float>(all(row, column));
    return result;
}

osg::ref_ptr<osg::Uniform> harmonicsOf(const RadianceCube& radiance)
{
    const std::array<osg::Vec3f, 9> harmonics = radiance.harmonics();
    osg::ref_ptr<osg::Uniform> uniform = new osg::Uniform(osg::Uniform::FLOAT_VEC3, "environmentHarmonics", 9);
    for (unsigned int i = 0; i < harmonics.size(); ++i)
        uniform->setElement(i, harmonics[i]);
    return uniform;
}

} // namespace

Environment::Environment()
{
    setIntensity(1.0f);
}

Environment::Environment(const Environment& other, const osg::CopyOp& copyop)
    : osg::Group(other, copyop), _intensity(other._intensity), _rotation(other._rotation),
      _toneMapping(other._toneMapping), _panorama(other._panorama), _faces(other._faces), _map(other._map),
      _harmonics(other._harmonics), _intensities(other._intensities)
{
}

Result<osg::ref_ptr<Environment>> Environment::fromFile(const std::string& file)
{
    const Result<osg::ref_ptr<osg::Image>> picture = readHdrFile(file);
    if (!picture) return picture.error();
    osg::ref_ptr<Environment> environment = new Environment;
    const Result<void> taken = environment->setPanorama(picture.value());
    if (!taken) return Error{file + ": " + taken.error().message};
    return environment;
}

void Environment::setStudio()
{
    _panorama = nullptr;
    _faces = nullptr;
    _map = nullptr;
    _harmonics = nullptr;
}

Result<void> Environment::setPanorama(osg::Image* panorama)
{
    if (!panorama) return Error{"a panorama: expected a picture, found null"};
    const Result<osg::ref_ptr<const RadianceCube>> radiance = RadianceCube::fromPanorama(*panorama);
    if (!radiance) return radiance.error();
    setPictures(panorama, nullptr, *radiance.value());
    return {};
}

Result<void> Environment::setFaces(osg::TextureCubeMap* faces)
{
    if (!faces) return Error{"the faces of surroundings: expected a cube map, found null"};
    const Result<osg::ref_ptr<const RadianceCube>> radiance = RadianceCube::fromFaces(*faces);
    if (!radiance) return radiance.error();
    setPictures(nullptr, faces, *radiance.value());
    return {};
}

void Environment::setPictures(osg::Image* panorama, osg::TextureCubeMap* faces, const RadianceCube& radiance)
{
    _panorama = panorama;
    _faces = faces;
    _map = new PrefilteredMap(radiance);
    _harmonics = harmonicsOf(radiance);
}

void Environment::setIntensity(float intensity)
{
    _intensity = std::isfinite(intensity) && intensity > 0.0f ? intensity : 0.0f;
    _intensities = new osg::Uniform("environmentIntensity", _intensity);
}

void Environment::setRotation(float radians)
{
    if (std::isfinite(radians)) _rotation = radians;
}

/// All state of the surroundings. It is not in the node's own StateSet, which belongs to the user and is stored.
osg::ref_ptr<osg::StateSet> Environment::makeLight(const osg::Matrix& nodeToEye) const
{
    osg::ref_ptr<osg::StateSet> light = new osg::StateSet;
    osg::ref_ptr<osg::Uniform> fromEye = new osg::Uniform(osg::Uniform::FLOAT_MAT3, "environmentFromEye");
    fromEye->set(environmentFromEye(nodeToEye, _rotation));
    light->addUniform(fromEye);
    light->addUniform(_intensities);
    light->setDefine("ENVIRONMENT", _map ? "2" : "1");
    if (_toneMapping) light->setDefine("TONE_MAPPING", "1");
    if (!_map) return light;
    light->setTextureAttribute(ENVIRONMENT_UNIT, _map);
    light->setMode(GL_TEXTURE_CUBE_MAP_SEAMLESS, osg::StateAttribute::ON);
    light->addUniform(_harmonics);
    light->addUniform(new osg::Uniform("environmentMap", ENVIRONMENT_UNIT));
    light->addUniform(new osg::Uniform("environmentLevels", static_cast<float>(PrefilteredMap::levels - 1)));
    return light;
}

void Environment::traverse(osg::NodeVisitor& visitor)
{
    osgUtil::CullVisitor* const cull = visitor.asCullVisitor();
    if (!cull) return osg::Group::traverse(visitor);
    // A new one for each camera and frame: the draw threads still use that of the frame before.
    const osg::ref_ptr<osg::StateSet> light = makeLight(*cull->getModelViewMatrix());
    cull->pushStateSet(light);
    osg::Group::traverse(visitor);
    cull->popStateSet();
}

void Environment::setThreadSafeRefUnref(bool threadSafe)
{
    osg::Group::setThreadSafeRefUnref(threadSafe);
    if (_map) _map->setThreadSafeRefUnref(threadSafe);
}

void Environment::resizeGLObjectBuffers(unsigned int maxSize)
{
    osg::Group::resizeGLObjectBuffers(maxSize);
    if (_map) _map->resizeGLObjectBuffers(maxSize);
}

void Environment::releaseGLObjects(osg::State* state) const
{
    osg::Group::releaseGLObjects(state);
    if (_map) _map->releaseGLObjects(state);
}

} // namespace osgGpuAnimation
