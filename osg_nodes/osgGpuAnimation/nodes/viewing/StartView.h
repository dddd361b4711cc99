// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <osg/Camera>
#include <osg/CameraView>
#include <osg/observer_ptr>
#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <string>

namespace osgGpuAnimation
{

/// Sets the camera's projection to that of the view, for the aspect ratio of the camera's viewport: perspective by a
/// vertical field of view, or parallel by orthographicHeightName. A CameraView with neither changes nothing.
void setProjection(osg::Camera& camera, const osg::CameraView& view);

/// From the view's space to the world, along the first path to it: a rotation and a translation. A scale above a camera
/// does not change what it shows (glTF 2.0, section 3.10.2). Attachments above it count as the last update left them.
osg::Matrixd viewToWorld(const osg::CameraView& view);

/// A viewer's first view through an osg::CameraView in the scene: an event callback on a node above it.
///
///     model->addEventCallback(new StartView("Camera"));
///
/// At the first frame of the first view that has a camera manipulator, the view gets the projection of the CameraView.
/// A CameraView that does not move becomes the home position of the manipulator (osgviewer's, too), which moves there.
/// One below a JointAttachment moves: the manipulator follows it until a mouse button or the wheel is used, and again
/// after the manipulators' home key, the space bar. The node finds the CameraView by its name, the first one below.
class StartView : public osgGA::GUIEventHandler
{
public:
    StartView() = default;
    explicit StartView(const std::string& camera) : _camera(camera) {} ///< camera: the name of an osg::CameraView
    /// Copies the name; the copy starts anew.
    StartView(const StartView& other, const osg::CopyOp& copyop)
        : osg::Object(other, copyop), osg::Callback(other, copyop), osgGA::GUIEventHandler(other, copyop),
          _camera(other._camera)
    {
    }
    META_Object(osgGpuAnimation, StartView)

    const std::string& getCamera() const { return _camera; }
    void setCamera(const std::string& camera) { _camera = camera; } ///< the name of an osg::CameraView

    using osgGA::GUIEventHandler::handle;
    /// Starts at the first frame, ends and resumes following, and follows each frame after the viewer's update
    /// traversal. Always returns false.
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action, osg::Object* object,
                osg::NodeVisitor* visitor) override;

protected:
    ~StartView() override = default;

private:
    void start(const osgGA::GUIEventAdapter& event, osgViewer::View& view, osg::Node& node);
    void follow(osg::Node& node);

    std::string _camera;
    osg::observer_ptr<osgViewer::View> _view; ///< the one that has started
    bool _hasStarted = false;
    bool _isFollowing = false;
};

} // namespace osgGpuAnimation
