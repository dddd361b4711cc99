// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/DetailScale.h>

#include <glm/geometric.hpp>

namespace osgGpuAnimation
{

DetailScale::Measure::Measure(const osg::Vec4& halfPixel, float pixelError)
    : errorAt(2.0f * pixelError * glm::vec4(halfPixel.x(), halfPixel.y(), halfPixel.z(), halfPixel.w())),
      slope(glm::length(glm::vec3(errorAt)))
{
}

DetailScale::DetailScale(osgUtil::CullVisitor& visitor, DetailView& view, float pixelError, const DetailRange& range)
    : _range(range)
{
    if (!(pixelError > 0.0f)) return;
    _seen = Measure(view.pixelSizeVector(visitor), pixelError);
    _own = Measure(visitor.getCurrentCullingSet().getPixelSizeVector(), pixelError);
}

int DetailScale::level(const glm::vec3& centre, float radius, float scale) const
{
    const Measure& measure = _seen.farthest(centre, radius) < 0.0f ? _own : _seen;
    return _range.held(DetailLevels::levelOf(measure.nearest(centre, radius) / scale));
}

} // namespace osgGpuAnimation
