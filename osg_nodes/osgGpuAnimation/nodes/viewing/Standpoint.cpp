// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/viewing/Standpoint.h>

#include <osg/BoundingBox>
#include <osg/Math>

#include <osgGA/CameraManipulator>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// From (0.55, -1, 0.3).
const ViewDirection raisedDirection{osg::RadiansToDegrees(std::atan2(0.55, 1.0)),
                                    osg::RadiansToDegrees(std::atan2(0.3, std::hypot(0.55, 1.0)))};

/// The distance from the middle along `back` at which the picture holds all points. tangent: of half the height.
double fittingDistance(const std::vector<osg::Vec3d>& points, const Standpoint& place, const osg::Vec3d (&axes)[3],
                       double tangent, double aspect)
{
    double distance = place.radius;
    for (const osg::Vec3d& point : points)
    {
        const osg::Vec3d offset = point - place.middle;
        const double spread = std::max(std::abs(offset * axes[1]), std::abs(offset * axes[0]) / aspect);
        distance = std::max(distance, spread / tangent + offset * axes[2]);
    }
    return distance;
}

/// A direction to the eye, and the direction that is up in the picture.
struct EyeDirection
{
    osg::Vec3d back;
    osg::Vec3d up;
};

EyeDirection eyeDirection(const ViewDirection& direction)
{
    const double azimuth = osg::DegreesToRadians(direction.azimuth);
    const double elevation = osg::DegreesToRadians(direction.elevation);
    const osg::Vec3d level(std::sin(azimuth), -std::cos(azimuth), 0.0), above(0.0, 0.0, 1.0);
    return {level * std::cos(elevation) + above * std::sin(elevation),
            above * std::cos(elevation) - level * std::sin(elevation)};
}

/// True if the points are less than half as high as their footprint is deep and wide.
bool lieFlat(const std::vector<osg::Vec3d>& points)
{
    osg::BoundingBoxd box;
    for (const osg::Vec3d& point : points)
        box.expandBy(point);
    const osg::Vec3d size = box.valid() ? box._max - box._min : osg::Vec3d();
    return size.z() < 0.5 * std::min(size.x(), size.y());
}

/// Height by width of the points in a parallel view.
double proportionOf(const std::vector<osg::Vec3d>& points, const ViewDirection& direction)
{
    const EyeDirection eye = eyeDirection(direction);
    const osg::Vec3d right = eye.up ^ eye.back;
    osg::BoundingBoxd box;
    for (const osg::Vec3d& point : points)
        box.expandBy(point * right, point * eye.up, 0.0);
    const double width = box.valid() ? box.xMax() - box.xMin() : 0.0;
    return width > 0.0 ? (box.yMax() - box.yMin()) / width : std::numeric_limits<double>::infinity();
}

} // namespace

Standpoint standpointFrom(const ViewDirection& direction, const std::vector<osg::Vec3d>& points, double fieldOfView,
                          double aspect, double margin)
{
    const auto& [back, up] = eyeDirection(direction);
    const double tangent = std::tan(osg::DegreesToRadians(fieldOfView) / 2.0) / margin;
    osg::Vec3d right = up ^ back;
    right.normalize();
    const osg::Vec3d axes[] = {right, back ^ right, back};
    osg::BoundingBoxd box; // along those axes
    for (const osg::Vec3d& point : points)
        box.expandBy(point * axes[0], point * axes[1], point * axes[2]);
    if (!box.valid()) box.set(-1, -1, -1, 1, 1, 1);

    Standpoint place;
    place.up = up;
    place.middle = axes[0] * box.center().x() + axes[1] * box.center().y() + axes[2] * box.center().z();
    place.radius = std::max(box.radius(), 1e-6);
    double distance = fittingDistance(points, place, axes, tangent, aspect);
    // Near points look larger, so the middle of the points is not the middle of the picture: a few steps centre it.
    for (int step = 0; step < 4; ++step)
    {
        osg::BoundingBoxd seen;
        for (const osg::Vec3d& point : points)
        {
            const osg::Vec3d offset = point - place.middle;
            const double depth = distance - offset * back;
            seen.expandBy(offset * axes[0] / depth, offset * axes[1] / depth, 0.0);
        }
        if (!seen.valid()) break;
        place.middle += (axes[0] * seen.center().x() + axes[1] * seen.center().y()) * distance;
        distance = fittingDistance(points, place, axes, tangent, aspect);
    }
    place.eye = place.middle + back * distance;
    return place;
}

Standpoint raisedStandpoint(const std::vector<osg::Vec3d>& points, double fieldOfView, double aspect, double margin)
{
    return standpointFrom(raisedDirection, points, fieldOfView, aspect, margin);
}

ViewDirection fillingDirection(const std::vector<osg::Vec3d>& points)
{
    constexpr double step = 4.0, maxElevation = 35.0; // degrees
    constexpr double enough = 0.6;                    // height by width: from there on, windows are well filled
    ViewDirection direction = raisedDirection;
    if (lieFlat(points))
        while (proportionOf(points, direction) < enough && direction.elevation + step <= maxElevation)
            direction.elevation += step;
    return direction;
}

void goHome(const osgGA::GUIEventAdapter& event, osgViewer::View& view, const Standpoint& place, const osg::Vec3d& up)
{
    osgGA::CameraManipulator& manipulator = *view.getCameraManipulator();
    manipulator.setHomePosition(place.eye, place.middle, up, false);
    manipulator.setAutoComputeHomePosition(false);
    manipulator.home(event, view);
}

} // namespace osgGpuAnimation
