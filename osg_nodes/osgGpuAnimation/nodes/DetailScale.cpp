// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/DetailScale.h>

#include <osgGpuAnimation/nodes/DepthPass.h>

#include <osg/Transform>

#include <glm/geometric.hpp>

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

/// OSG divides a radius by the vector's product with the place and has a diameter in pixels.
osg::Vec4 pixelSizeVector(osgUtil::CullVisitor& visitor)
{
    const osg::Vec4 own = visitor.getCurrentCullingSet().getPixelSizeVector();
    const osg::Camera* camera = visitor.getCurrentCamera();
    if (!camera || !DepthPass::isOf(*camera) || !isAbsolute(camera)) return own;
    const osg::NodePath& path = visitor.getNodePath();
    const auto place = std::find(path.rbegin(), path.rend(), camera);
    if (place == path.rend()) return own;
    // What the shadow map's camera was met below, and so what space its own world is, and who sees that.
    const osg::NodePath above(path.begin(), std::prev(place.base()));
    const auto nested = std::find_if(above.rbegin(), above.rend(), isAbsolute);
    const osg::Camera* root = visitor.getRenderStage()->getCamera();
    const osg::Camera* eye = nested == above.rend() ? root : (*nested)->asCamera();
    const osg::Viewport* viewport =
        eye && eye->getViewport() ? eye->getViewport() : visitor.getRenderStage()->getViewport();
    if (!root || !viewport) return own;
    const osg::Matrix toEye = *visitor.getModelViewMatrix() * camera->getInverseViewMatrix() *
                              osg::computeLocalToEye(root->getViewMatrix(), above, false);
    return osg::CullingSet::computePixelSizeVector(*viewport, eye->getProjectionMatrix(), toEye);
}

} // namespace

DetailScale::DetailScale(osgUtil::CullVisitor& visitor, float pixelError, const DetailRange& range) : _range(range)
{
    if (!(pixelError > 0.0f)) return;
    const osg::Vec4 halfPixel = pixelSizeVector(visitor);
    _errorAt = 2.0f * pixelError * glm::vec4(halfPixel.x(), halfPixel.y(), halfPixel.z(), halfPixel.w());
    _slope = glm::length(glm::vec3(_errorAt));
}

int DetailScale::level(const glm::vec3& centre, float radius, float scale) const
{
    const float error = glm::dot(_errorAt, glm::vec4(centre, 1.0f)) - _slope * radius;
    return _range.held(DetailLevels::levelOf(error / scale));
}

} // namespace osgGpuAnimation
