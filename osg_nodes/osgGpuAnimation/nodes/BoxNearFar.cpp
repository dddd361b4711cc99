// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/BoxNearFar.h>

namespace osgGpuAnimation
{

BoxNearFar::BoxNearFar(osgUtil::CullVisitor& visitor)
    : _visitor(visitor), _mode(visitor.getComputeNearFarMode()), _inheritance(visitor.getInheritanceMask())
{
    if (_mode == osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES ||
        _mode == osg::CullSettings::COMPUTE_NEAR_USING_PRIMITIVES)
        _visitor.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
}

BoxNearFar::~BoxNearFar()
{
    if (_visitor.getComputeNearFarMode() == _mode) return;
    _visitor.setComputeNearFarMode(_mode);
    _visitor.setInheritanceMask(_inheritance);
}

} // namespace osgGpuAnimation
