// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/TiltedHome.h>

#include <osg/Math>
#include <osg/Transform>
#include <osgViewer/View>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// Of directions and, as a part of the distance, of places: what a quaternion does to them is far below.
constexpr double tolerance = 1e-6;

bool standsUpright(const osg::NodePath& path)
{
    osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), osg::computeLocalToWorld(path));
    up.normalize();
    return (up - osg::Vec3d(0, 0, 1)).length() < tolerance;
}

/// How far before the middle the eye is, where it looks at it along +Y with +Z up; 0 where it does not.
double levelDistance(const osg::Matrixd& viewMatrix, const osg::Vec3d& middle)
{
    osg::Vec3d eye, ahead, up;
    viewMatrix.getLookAt(eye, ahead, up);
    const double distance = middle.y() - eye.y();
    const bool isBefore =
        distance > 0.0 && std::hypot(eye.x() - middle.x(), eye.z() - middle.z()) < tolerance * distance;
    const bool isLevel = (ahead - eye - osg::Vec3d(0, 1, 0)).length() < tolerance && up.z() > 1.0 - tolerance;
    return isBefore && isLevel ? distance : 0.0;
}

} // namespace

TiltedHome::TiltedHome(const TiltedHome& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osgGA::GUIEventHandler(other, copyop)
{
}

bool TiltedHome::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object*,
                        osg::NodeVisitor* visitor)
{
    if (event.getEventType() != osgGA::GUIEventAdapter::FRAME) return false;
    auto* view = dynamic_cast<osgViewer::View*>(action.asView());
    osgGA::CameraManipulator* manipulator = view ? view->getCameraManipulator() : nullptr;
    if (!manipulator || !manipulator->getAutoComputeHomePosition() || !view->getSceneData()) return false;
    const osg::Vec3d middle = view->getSceneData()->getBound().center();
    const double distance = levelDistance(manipulator->getInverseMatrix(), middle);
    if (distance <= 0.0 || (visitor && !standsUpright(visitor->getNodePath()))) return false;
    const double angle = osg::DegreesToRadians(degrees);
    const osg::Vec3d back(0.0, -std::cos(angle), std::sin(angle));
    manipulator->setByInverseMatrix(osg::Matrixd::lookAt(middle + back * distance, middle, osg::Vec3d(0, 0, 1)));
    action.requestRedraw();
    return false;
}

} // namespace osgGpuAnimation
