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
    osg::Vec3d up = {0, 0, 1};
    double radius = 1.0; ///< of the points around the middle
};

/// From where a model is seen, in degrees. 0, 0: level, from -Y, the front of a glTF model.
struct ViewDirection
{
    double azimuth = 0.0;   ///< counter-clockwise from above: 90 is from +X, the model's left
    double elevation = 0.0; ///< in [-90, 90]; 90: from above, with the back of the model up in the picture
};

/// From there all points are visible, in the middle, and as large as possible.
/// fieldOfView: degrees, vertical. aspect: width by height. margin: size of the picture relative to the points in it.
Standpoint standpointFrom(const ViewDirection& direction, const std::vector<osg::Vec3d>& points, double fieldOfView,
                          double aspect, double margin);

/// The same from -Y, a little from +X and from above: the direction 28.8, 14.7. Up is +Z.
Standpoint raisedStandpoint(const std::vector<osg::Vec3d>& points, double fieldOfView, double aspect, double margin);

/// That direction, too, but from up to 35 degrees above points that lie flat, such as a crowd: they would fill a narrow
/// strip of the picture.
ViewDirection fillingDirection(const std::vector<osg::Vec3d>& points);

/// Makes it the home position of the view's camera manipulator, which must exist and goes there. up: above 0 in length.
void goHome(const osgGA::GUIEventAdapter& event, osgViewer::View& view, const Standpoint& place, const osg::Vec3d& up);

} // namespace osgGpuAnimation
