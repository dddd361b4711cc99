// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/DetailScale.h>

#include <glm/geometric.hpp>

namespace osgGpuAnimation
{

DetailScale::DetailScale(osgUtil::CullVisitor& visitor, float pixelError, const DetailRange& range) : _range(range)
{
    if (!(pixelError > 0.0f)) return;
    // OSG divides a radius by the vector's product with the place and has a diameter in pixels.
    const osg::Vec4 halfPixel = visitor.getCurrentCullingSet().getPixelSizeVector();
    _errorAt = 2.0f * pixelError * glm::vec4(halfPixel.x(), halfPixel.y(), halfPixel.z(), halfPixel.w());
    _slope = glm::length(glm::vec3(_errorAt));
}

int DetailScale::level(const glm::vec3& centre, float radius, float scale) const
{
    const float error = glm::dot(_errorAt, glm::vec4(centre, 1.0f)) - _slope * radius;
    return _range.held(DetailLevels::levelOf(error / scale));
}

} // namespace osgGpuAnimation
