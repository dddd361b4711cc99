// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/studio/KeyShadow.h>

#include <osg/ColorMask>
#include <osg/PolygonMode>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// Leads a traversal to the children of the group, not to the group itself.
class Casters : public osg::Node
{
public:
    explicit Casters(osg::Group& group) : _group(&group) { setCullingActive(false); }
    void traverse(osg::NodeVisitor& visitor) override { _group->osg::Group::traverse(visitor); }

protected:
    ~Casters() override = default;

private:
    osg::Group* _group; ///< owns the camera above this node
};

} // namespace

KeyShadow::KeyShadow(osg::Group& casters) : _map(new osg::Texture2D), _size(1.0, 1.0, 1.0)
{
    _map->setTextureSize(mapSide, mapSide);
    _map->setInternalFormat(GL_DEPTH_COMPONENT24);
    _map->setSourceFormat(GL_DEPTH_COMPONENT);
    _map->setSourceType(GL_UNSIGNED_INT);
    for (const osg::Texture::FilterParameter filter : {osg::Texture::MIN_FILTER, osg::Texture::MAG_FILTER})
        _map->setFilter(filter, osg::Texture::NEAREST);
    for (const osg::Texture::WrapParameter wrap : {osg::Texture::WRAP_S, osg::Texture::WRAP_T})
        _map->setWrap(wrap, osg::Texture::CLAMP_TO_BORDER);
    _map->setBorderColor(osg::Vec4d(1, 1, 1, 1));

    setReferenceFrame(ABSOLUTE_RF);
    setRenderOrder(PRE_RENDER);
    setRenderTargetImplementation(FRAME_BUFFER_OBJECT);
    attach(DEPTH_BUFFER, _map);
    setClearMask(GL_DEPTH_BUFFER_BIT);
    setViewport(0, 0, mapSide, mapSide);
    setComputeNearFarMode(DO_NOT_COMPUTE_NEAR_FAR);
    setCullingActive(false);
    setAllowEventFocus(false);
    osg::StateSet* state = getOrCreateStateSet();
    state->setDefine("POSE_DEPTH_ONLY");
    state->setAttribute(new osg::ColorMask(false, false, false, false), osg::StateAttribute::PROTECTED);
    state->setAttribute(new osg::PolygonMode, osg::StateAttribute::PROTECTED); // whatever osgviewer's key w has set
    addChild(new Casters(casters));
}

void KeyShadow::fit(const osg::BoundingBoxd& box, const osg::Vec3d& towardsLight)
{
    const osg::Vec3d middle = box.center(), up(0, std::abs(towardsLight.z()) > 0.99, 1); // not parallel to the light
    const osg::Matrixd view = osg::Matrixd::lookAt(middle + towardsLight * box.radius(), middle, up);
    osg::BoundingBoxd seen;
    for (unsigned int corner = 0; corner < 8; ++corner)
        seen.expandBy(box.corner(corner) * view);
    const osg::Vec3d margin(0.01 * box.radius(), 0.01 * box.radius(), 0.01 * box.radius());
    seen._min -= margin;
    seen._max += margin;
    _size = seen._max - seen._min;
    setViewMatrix(view);
    setProjectionMatrixAsOrtho(seen.xMin(), seen.xMax(), seen.yMin(), seen.yMax(), -seen.zMax(), -seen.zMin());
}

osg::Matrixd KeyShadow::toMap() const
{
    return getViewMatrix() * getProjectionMatrix() * osg::Matrixd::translate(1, 1, 1) *
           osg::Matrixd::scale(0.5, 0.5, 0.5);
}

} // namespace osgGpuAnimation
