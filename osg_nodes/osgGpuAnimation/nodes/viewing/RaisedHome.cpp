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

} // namespace

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
    const std::vector<osg::Vec3d> points = group ? pointsOf(*group, 12) : std::vector<osg::Vec3d>();
    if (points.empty()) return false;

    Standpoint place = standpointFrom(fillingDirection(points), points, fieldOfView, aspect, margin);
    const osg::Matrixd toWorld = osg::computeLocalToWorld(visitor->getNodePath());
    const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), toWorld);
    place.eye = place.eye * toWorld;
    place.middle = place.middle * toWorld;
    goHome(event, *view, place, up);
    return false;
}

} // namespace osgGpuAnimation
