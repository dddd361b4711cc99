// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/Environment.h>

#include <osg/Matrix>
#include <osg/Uniform>
#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

namespace
{

/// From eye space to glTF's axes (+Y up) of the surroundings.
osg::Matrix3 environmentFromEye(const osg::Matrix& nodeToEye, float rotation)
{
    osg::Matrix turn;
    turn.orthoNormalize(nodeToEye);
    turn.setTrans(0, 0, 0);
    const osg::Matrix yUp(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
    const osg::Matrix all = osg::Matrix::inverse(turn) * osg::Matrix::rotate(-rotation, osg::Vec3(0, 0, 1)) * yUp;
    osg::Matrix3 result;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            result(row, column) = static_cast<float>(all(row, column));
    return result;
}

} // namespace

Environment::Environment()
{
    getOrCreateStateSet()->setDefine("ENVIRONMENT", "1");
    setIntensity(1.0f);
}

Environment::Environment(const Environment& other, const osg::CopyOp& copyop)
    : osg::Group(other, copyop), _intensity(other._intensity), _rotation(other._rotation),
      _toneMapping(other._toneMapping)
{
    if (other.getStateSet() == getStateSet()) setStateSet(new osg::StateSet(*other.getStateSet(), copyop));
    setIntensity(_intensity);
}

void Environment::setIntensity(float intensity)
{
    _intensity = intensity;
    getOrCreateStateSet()->addUniform(new osg::Uniform("environmentIntensity", intensity));
}

void Environment::setToneMapping(bool isOn)
{
    _toneMapping = isOn;
    if (isOn)
        getOrCreateStateSet()->setDefine("TONE_MAPPING", "1");
    else
        getOrCreateStateSet()->removeDefine("TONE_MAPPING");
}

void Environment::traverse(osg::NodeVisitor& visitor)
{
    osgUtil::CullVisitor* const cull = visitor.asCullVisitor();
    if (!cull) return osg::Group::traverse(visitor);
    // A new one for each camera and frame: the draw threads still use that of the frame before.
    osg::ref_ptr<osg::StateSet> turned = new osg::StateSet;
    osg::ref_ptr<osg::Uniform> fromEye = new osg::Uniform(osg::Uniform::FLOAT_MAT3, "environmentFromEye");
    fromEye->set(environmentFromEye(*cull->getModelViewMatrix(), _rotation));
    turned->addUniform(fromEye);
    cull->pushStateSet(turned);
    osg::Group::traverse(visitor);
    cull->popStateSet();
}

} // namespace osgGpuAnimation
