// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/DetailView.h>

#include <osgGpuAnimation/nodes/DepthPass.h>

#include <osg/Transform>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

bool isAbsolute(const osg::Node* node)
{
    const auto* camera = dynamic_cast<const osg::Camera*>(node);
    return camera && camera->getReferenceFrame() != osg::Transform::RELATIVE_RF;
}

} // namespace

osg::Vec4 DetailView::pixelSizeVector(osgUtil::CullVisitor& visitor)
{
    if (visitor.getProjectionMatrix() != _projection || visitor.getCurrentCamera() != _culled) find(visitor);
    if (!_eye) return visitor.getCurrentCullingSet().getPixelSizeVector();
    return osg::CullingSet::computePixelSizeVector(*_viewport, _eye->getProjectionMatrix(),
                                                   *visitor.getModelViewMatrix() * _toEye);
}

void DetailView::find(osgUtil::CullVisitor& visitor)
{
    _projection = visitor.getProjectionMatrix();
    _culled = visitor.getCurrentCamera();
    _eye = nullptr;
    if (!_culled || !DepthPass::isOf(*_culled) || !isAbsolute(_culled)) return;
    const osg::NodePath& path = visitor.getNodePath();
    const auto place = std::find(path.rbegin(), path.rend(), _culled);
    if (place == path.rend()) return;
    // What the shadow map's camera was met below, and so what space its own world is, and who sees that.
    const osg::NodePath above(path.begin(), std::prev(place.base()));
    const auto nested = std::find_if(above.rbegin(), above.rend(), isAbsolute);
    const osg::Camera* root = visitor.getRenderStage()->getCamera();
    const osg::Camera* eye = nested == above.rend() ? root : (*nested)->asCamera();
    _viewport = eye && eye->getViewport() ? eye->getViewport() : visitor.getRenderStage()->getViewport();
    if (!root || !_viewport) return;
    _eye = eye;
    _toEye = _culled->getInverseViewMatrix() * osg::computeLocalToEye(root->getViewMatrix(), above, false);
}

} // namespace osgGpuAnimation
