// SPDX-License-Identifier: MIT
#pragma once

#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

/// While it lives, near and far planes come from bounding boxes where the visitor would look at primitives: those of a
/// SkinnedGeometry are its bind pose's, and a limb that reaches beyond it would be clipped. Boxes hold every pose.
class BoxNearFar
{
public:
    explicit BoxNearFar(osgUtil::CullVisitor& visitor);
    ~BoxNearFar();
    BoxNearFar(const BoxNearFar&) = delete;
    BoxNearFar& operator=(const BoxNearFar&) = delete;

private:
    osgUtil::CullVisitor& _visitor;
    osg::CullSettings::ComputeNearFarMode _mode;     ///< as it was
    osg::CullSettings::InheritanceMask _inheritance; ///< as it was: setting the mode changes it
};

} // namespace osgGpuAnimation
