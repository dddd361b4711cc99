// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/TiltedHome.h>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgGA/EventVisitor>
#include <osgGA/FlightManipulator>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgGA/OrbitManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

namespace osgGpuAnimation
{

namespace
{

const osg::Vec3d middle(30.0, 40.0, 5.0);

/// A square of 20 units that lies on the ground.
osg::ref_ptr<osg::Geometry> makeField()
{
    osg::ref_ptr<osg::Geometry> field = osg::createTexturedQuadGeometry(osg::Vec3(middle) - osg::Vec3(10, 10, 0),
                                                                        osg::Vec3(20, 0, 0), osg::Vec3(0, 20, 0));
    field->addEventCallback(new TiltedHome);
    return field;
}

/// A viewer without a window that shows the field.
class TiltedHomeTest : public ::testing::Test
{
protected:
    void look(osgGA::CameraManipulator* with, osg::Node* at)
    {
        viewer->setCameraManipulator(with);
        viewer->setSceneData(at);
    }

    /// The frame event, as viewers send it to their scene.
    void beginFrame()
    {
        osg::ref_ptr<osgGA::EventVisitor> visitor = new osgGA::EventVisitor;
        visitor->setActionAdapter(viewer);
        osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
        event->setEventType(osgGA::GUIEventAdapter::FRAME);
        visitor->addEvent(event);
        viewer->getSceneData()->accept(*visitor);
    }

    osg::Matrixd view() const { return viewer->getCameraManipulator()->getInverseMatrix(); }

    void goHome() { viewer->home(); }

    /// The view is raised by the angle about the middle of the field, as far from it as home is.
    void expectTilted(const osg::Matrixd& home)
    {
        osg::Vec3d homeEye, eye, ahead, up;
        home.getLookAt(homeEye, ahead, up);
        view().getLookAt(eye, ahead, up, (middle - homeEye).length());
        const double angle = osg::DegreesToRadians(TiltedHome::degrees);
        const double distance = middle.y() - homeEye.y();
        const osg::Vec3d raised = middle + osg::Vec3d(0.0, -std::cos(angle), std::sin(angle)) * distance;
        EXPECT_NEAR((eye - raised).length(), 0.0, 1e-6 * distance);
        EXPECT_NEAR((ahead - middle).length(), 0.0, 1e-6 * distance);
        EXPECT_NEAR(up.x(), 0.0, 1e-6);
    }

    osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
};

osg::ref_ptr<osgGA::CameraManipulator> makeKeySwitch()
{
    osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> all = new osgGA::KeySwitchMatrixManipulator;
    all->addMatrixManipulator('1', "Trackball", new osgGA::TrackballManipulator);
    all->addMatrixManipulator('2', "Flight", new osgGA::FlightManipulator);
    return all;
}

} // namespace

TEST_F(TiltedHomeTest, theHomeViewIsFromALittleAbove)
{
    const osg::ref_ptr<osgGA::CameraManipulator> manipulators[] = {
        new osgGA::TrackballManipulator, new osgGA::OrbitManipulator, new osgGA::FlightManipulator, makeKeySwitch()};
    for (const osg::ref_ptr<osgGA::CameraManipulator>& manipulator : manipulators)
    {
        SCOPED_TRACE(manipulator->className());
        look(manipulator, makeField());
        const osg::Matrixd home = view();
        beginFrame();
        expectTilted(home);
        const osg::Matrixd tilted = view();
        beginFrame();
        EXPECT_EQ(view(), tilted);
        goHome();
        beginFrame();
        expectTilted(home);
        EXPECT_TRUE(manipulator->getAutoComputeHomePosition());
    }
}

TEST_F(TiltedHomeTest, anyOtherViewStaysAsItIs)
{
    osg::ref_ptr<osgGA::TrackballManipulator> trackball = new osgGA::TrackballManipulator;
    look(trackball, makeField());
    const osg::Vec3d up(0, 0, 1);
    for (const osg::Vec3d& eye : {osg::Vec3d(30, 10, 6), osg::Vec3d(31, 10, 5), osg::Vec3d(30, 80, 5),
                                  osg::Vec3d(0, 40, 5), osg::Vec3d(30, 40, 50)})
    {
        trackball->setByInverseMatrix(osg::Matrixd::lookAt(eye, middle, eye.z() > 40 ? osg::Vec3d(0, 1, 0) : up));
        const osg::Matrixd before = view();
        beginFrame();
        EXPECT_EQ(view(), before) << eye.x() << " " << eye.y() << " " << eye.z();
    }
    // Past the middle: turned, and moved to the side.
    const osg::Vec3d place(30, 10, 5), aside(3, 0, 0);
    for (const osg::Vec3d& eye : {place, place + aside})
    {
        trackball->setByInverseMatrix(osg::Matrixd::lookAt(eye, middle + aside, up));
        const osg::Matrixd before = view();
        beginFrame();
        EXPECT_EQ(view(), before) << eye.x();
    }
}

TEST_F(TiltedHomeTest, theApplicationsOwnHomeStays)
{
    osg::ref_ptr<osgGA::TrackballManipulator> trackball = new osgGA::TrackballManipulator;
    trackball->setHomePosition(middle - osg::Vec3d(0, 50, 0), middle, osg::Vec3d(0, 0, 1));
    look(trackball, makeField());
    const osg::Matrixd before = view();
    beginFrame();
    EXPECT_EQ(view(), before);
}

TEST_F(TiltedHomeTest, whatIsTurnedIsSeenAsItIs)
{
    osg::ref_ptr<osg::MatrixTransform> turned = new osg::MatrixTransform(osg::Matrix::rotate(0.5, osg::X_AXIS));
    turned->addChild(makeField());
    look(new osgGA::TrackballManipulator, turned);
    const osg::Matrixd before = view();
    beginFrame();
    EXPECT_EQ(view(), before);
}

TEST_F(TiltedHomeTest, viewersNeedNoManipulator)
{
    look(nullptr, makeField());
    beginFrame();
    EXPECT_FALSE(viewer->getCameraManipulator());
}

} // namespace osgGpuAnimation
