// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/viewing/Standpoint.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/ValueObject>
#include <osgGA/CameraManipulator>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

bool isBelowAttachment(const osg::Node& node)
{
    return findAbove(node,
                     [](const osg::Node& each) { return dynamic_cast<const JointAttachment*>(&each) != nullptr; });
}

/// The position of the camera, and its target: manipulators turn about it.
Standpoint standpointOf(const osgViewer::View& view, const osg::Matrixd& toWorld)
{
    Standpoint place;
    place.eye = toWorld.getTrans();
    const osg::Vec3d ahead = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, -1), toWorld);
    // As deep as the scene's middle, where the camera looks at it.
    const osg::BoundingSphere bound = view.getSceneData() ? view.getSceneData()->getBound() : osg::BoundingSphere();
    const double depth = bound.valid() ? (osg::Vec3d(bound.center()) - place.eye) * ahead : 1.0;
    const double distance = depth > 0.0 ? depth : std::max<double>(bound.radius(), 1e-6);
    place.middle = place.eye + ahead * distance;
    return place;
}

} // namespace

void setProjection(osg::Camera& camera, const osg::CameraView& view)
{
    double height = 0.0;
    const osg::Viewport* viewport = camera.getViewport();
    const double aspect = viewport && viewport->aspectRatio() > 0.0 ? viewport->aspectRatio() : 1.0;
    // The cull traversal computes the near and far planes.
    if (view.getUserValue(orthographicHeightName, height))
        camera.setProjectionMatrixAsOrtho(-0.5 * height * aspect, 0.5 * height * aspect, -0.5 * height, 0.5 * height,
                                          1.0, 10000.0);
    else if (view.getFieldOfViewMode() == osg::CameraView::VERTICAL)
        camera.setProjectionMatrixAsPerspective(view.getFieldOfView(), aspect, 1.0, 10000.0);
}

osg::Matrixd viewToWorld(const osg::CameraView& view)
{
    const osg::MatrixList paths = view.getWorldMatrices();
    if (paths.empty()) return osg::Matrixd();
    return rotationOf(paths.front()) * osg::Matrixd::translate(paths.front().getTrans());
}

bool StartView::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                       osg::NodeVisitor*)
{
    auto* view = dynamic_cast<osgViewer::View*>(action.asView());
    auto* node = dynamic_cast<osg::Node*>(object);
    if (!view || !node || !view->getCameraManipulator() || (_hasStarted && view != _view.get())) return false;
    using Event = osgGA::GUIEventAdapter;
    switch (event.getEventType())
    {
    case Event::FRAME:
        if (!_hasStarted) start(event, *view, *node);
        if (_isFollowing)
            runAfterUpdateOf(*node,
                             [self = osg::ref_ptr<StartView>(this)](osg::Node& watched)
                             {
                                 if (self->_isFollowing) self->follow(watched);
                             });
        break;
    case Event::PUSH:
    case Event::SCROLL:
        _isFollowing = false;
        break;
    case Event::KEYDOWN:
        if (_hasStarted && event.getKey() == Event::KEY_Space)
        {
            const osg::CameraView* const camera = findBelow<osg::CameraView>(*node, &_camera);
            _isFollowing = camera && isBelowAttachment(*camera);
        }
        break;
    default:
        break;
    }
    return false;
}

void StartView::start(const osgGA::GUIEventAdapter& event, osgViewer::View& view, osg::Node& node)
{
    const osg::CameraView* const camera = findBelow<osg::CameraView>(node, &_camera);
    _hasStarted = true;
    _view = &view;
    if (!camera) return;
    _isFollowing = isBelowAttachment(*camera);
    setProjection(*view.getCamera(), *camera);
    const osg::Matrixd toWorld = viewToWorld(*camera);
    goHome(event, view, standpointOf(view, toWorld), osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), toWorld));
}

void StartView::follow(osg::Node& node)
{
    const osg::CameraView* const camera = findBelow<osg::CameraView>(node, &_camera);
    // Not lock(): a viewer on the stack, as osgviewer's, has no references.
    if (camera && _view.valid() && markOf(*camera, cameraMark)) setProjection(*_view->getCamera(), *camera);
    if (camera && _view.valid() && _view->getCameraManipulator())
        _view->getCameraManipulator()->setByMatrix(viewToWorld(*camera));
}

} // namespace osgGpuAnimation
