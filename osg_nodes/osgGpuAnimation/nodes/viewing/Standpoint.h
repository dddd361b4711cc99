// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec3d>
#include <osgViewer/View>

#include <vector>

namespace osgGpuAnimation
{

/// The position of a camera and its target.
struct Standpoint
{
    osg::Vec3d eye;
    osg::Vec3d middle;
    double radius = 1.0; ///< of the points around the middle
};

/// From -Y, a little from +X and from above: all points are visible, in the middle, and as large as possible. Up is +Z.
/// fieldOfView: degrees, vertical. aspect: width by height. margin: size of the picture relative to the points in it.
Standpoint raisedStandpoint(const std::vector<osg::Vec3d>& points, double fieldOfView, double aspect, double margin);

/// Makes it the home position of the view's camera manipulator, which must exist and goes there. up: above 0 in length.
void goHome(const osgGA::GUIEventAdapter& event, osgViewer::View& view, const Standpoint& place, const osg::Vec3d& up);

} // namespace osgGpuAnimation
