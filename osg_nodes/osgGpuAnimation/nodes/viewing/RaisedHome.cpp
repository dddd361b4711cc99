// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/viewing/RaisedHome.h>

#include <osgGpuAnimation/nodes/studio/ModelExtent.h>
#include <osgGpuAnimation/nodes/viewing/Standpoint.h>

#include <osg/Transform>
#include <osgViewer/View>

namespace osgGpuAnimation
{

namespace
{

constexpr double margin = 1.12; ///< size of the window relative to the points in it

/// What the window must show: the first pose, and how far the present clips reach along each axis. The corners of that
/// box would make the model too small.
std::vector<osg::Vec3d> shownPoints(osg::Group& group)
{
    std::vector<osg::Vec3d> points = pointsOf(group);
    const osg::BoundingBoxd box = extentOf(group);
    for (int axis = 0; axis < 3 && box.valid(); ++axis)
        for (const osg::Vec3d& end : {box._min, box._max})
        {
            points.push_back(box.center());
            points.back()[axis] = end[axis];
        }
    return points;
}

} // namespace

RaisedHome::RaisedHome(const RaisedHome& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osgGA::GUIEventHandler(other, copyop)
{
}

bool RaisedHome::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                        osg::NodeVisitor* visitor)
{
    auto* view = dynamic_cast<osgViewer::View*>(action.asView());
    auto* node = dynamic_cast<osg::Node*>(object);
    osgGA::CameraManipulator* manipulator = view ? view->getCameraManipulator() : nullptr;
    if (event.getEventType() != osgGA::GUIEventAdapter::FRAME || !node || !visitor || !manipulator ||
        !manipulator->getAutoComputeHomePosition())
        return false;
    double fieldOfView = 0.0, aspect = 1.0, zNear = 0.0, zFar = 0.0;
    if (!view->getCamera()->getProjectionMatrixAsPerspective(fieldOfView, aspect, zNear, zFar)) return false;
    osg::Group* const group = node->asGroup();
    const std::vector<osg::Vec3d> points = group ? shownPoints(*group) : std::vector<osg::Vec3d>();
    if (points.empty()) return false;

    Standpoint place = raisedStandpoint(points, fieldOfView, aspect, margin);
    const osg::Matrixd toWorld = osg::computeLocalToWorld(visitor->getNodePath());
    const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), toWorld);
    place.eye = place.eye * toWorld;
    place.middle = place.middle * toWorld;
    goHome(event, *view, place, up);
    return false;
}

} // namespace osgGpuAnimation
