// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/studio/Studio.h>

#include <osgGpuAnimation/looks/environment/PrefilteredMap.h>
#include <osgGpuAnimation/nodes/studio/KeyShadow.h>
#include <osgGpuAnimation/nodes/studio/ModelExtent.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>

#include <osg/LightModel>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// GL's lights, whose modes osgviewer's headlight and the application's lights switch on.
constexpr unsigned int lights = 8;
/// The light on meshes without PbrMaterial.
constexpr float evenLight = 0.8f;

/// Of the studio's formula, see environment.glsl.
KeyLight studioLight()
{
    KeyLight light;
    light.towards = osg::Vec3f(0.6f, 1.1f, 0.9f);
    light.towards.normalize();
    light.share = 0.29f;
    return light;
}

} // namespace

Studio::Studio() : _shadow(new KeyShadow(*this))
{
    // The update traversal must reach this node without a callback.
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
    setToneMapping(true);
    osg::StateSet* state = getOrCreateStateSet();
    for (unsigned int light = 0; light < lights; ++light)
        state->setMode(GL_LIGHT0 + light, osg::StateAttribute::OFF);
    state->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    osg::ref_ptr<osg::LightModel> ambient = new osg::LightModel;
    ambient->setAmbientIntensity(osg::Vec4(evenLight, evenLight, evenLight, 1.0f));
    state->setAttribute(ambient);
}

Studio::Studio(const Studio& other, const osg::CopyOp& copyop)
    : Environment(other, copyop), _shadow(new KeyShadow(*this))
{
    setNumChildrenRequiringUpdateTraversal(getNumChildrenRequiringUpdateTraversal() + 1);
}

void Studio::traverse(osg::NodeVisitor& visitor)
{
    osgUtil::CullVisitor* const cull = visitor.asCullVisitor();
    const osg::Camera* const camera = cull ? cull->getCurrentCamera() : nullptr;
    if (cull && !(camera && DepthPass::isOf(*camera)))
    {
        if (_ground) _shadow->accept(*cull);
        _backdrop.cull(*cull, _ground, *_shadow);
    }
    Environment::traverse(visitor);
    if (visitor.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR) fit();
}

void Studio::fit()
{
    const osg::BoundingSphere& bound = getBound();
    if (!fitLight() && bound.center() == _fitted.center() && bound.radius() == _fitted.radius()) return;
    _fitted = bound;
    const osg::BoundingBoxd box = extentOf(*this);
    const double radius = box.radius();
    if (!box.valid() || !(radius > 0.0) || !std::isfinite(radius)) return;
    if (!_ground)
    {
        _ground = Ground{{0, 0, box.zMax()}, radius, 1.0};
        for (const osg::Vec3d& point : pointsOf(*this))
            _ground->middle.z() = std::min(_ground->middle.z(), point.z());
        _ground->height = std::max(box.zMax() - _ground->middle.z(), 0.01 * radius);
    }
    _ground->middle.x() = box.center().x();
    _ground->middle.y() = box.center().y();
    _ground->shade = _shade;
    _shadow->fit(box, _towardsLight);
}

/// True if the light is another than before.
bool Studio::fitLight()
{
    constexpr double emphasis = 2.0, darkest = 0.8; // shadows are darker than in truth, never black
    const osg::TextureCubeMap* const map = getMap();
    const float rotation = getRotation();
    if (_towardsLight.length2() > 0.0 && map == _fittedMap && rotation == _fittedRotation) return false;
    _fittedMap = map;
    _fittedRotation = rotation;
    const KeyLight light = map ? static_cast<const PrefilteredMap*>(map)->getRadiance().keyLight() : studioLight();
    const osg::Vec3d towards(light.towards.x(), -light.towards.z(), light.towards.y());
    _towardsLight = osg::Quat(static_cast<double>(rotation), osg::Vec3d(0, 0, 1)) * towards;
    _shade = std::min(emphasis * static_cast<double>(light.share), darkest);
    return true;
}

void Studio::resizeGLObjectBuffers(unsigned int maxSize)
{
    Environment::resizeGLObjectBuffers(maxSize);
    _shadow->resizeGLObjectBuffers(maxSize);
    _backdrop.getDrawable().resizeGLObjectBuffers(maxSize);
}

void Studio::releaseGLObjects(osg::State* state) const
{
    Environment::releaseGLObjects(state);
    _shadow->releaseGLObjects(state);
    _backdrop.getDrawable().releaseGLObjects(state);
}

void Studio::setThreadSafeRefUnref(bool threadSafe)
{
    Environment::setThreadSafeRefUnref(threadSafe);
    _shadow->setThreadSafeRefUnref(threadSafe);
    _backdrop.getDrawable().setThreadSafeRefUnref(threadSafe);
}

} // namespace osgGpuAnimation
