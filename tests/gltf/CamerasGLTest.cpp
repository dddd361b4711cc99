// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "serializers/StoredScene.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osg/Math>
#include <osg/ValueObject>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgGA/TrackballManipulator>

#include <iterator>
#include <tuple>
#include <utility>

// Views through the file's own cameras, as osgviewer would have them at its first frame.

namespace osgGpuAnimation::gltf
{

namespace
{

/// A node with a camera of its own.
int cameraNode(ModelBuilder& file, const std::string& name, const std::string& type, double size,
               const std::vector<double>& place, int parent = -1)
{
    tinygltf::Camera camera;
    camera.name = name;
    camera.type = type;
    camera.perspective.yfov = camera.orthographic.xmag = camera.orthographic.ymag = size;
    camera.perspective.znear = camera.orthographic.znear = 0.1;
    camera.perspective.zfar = camera.orthographic.zfar = 100.0;
    file.model.cameras.push_back(camera);
    const int node = file.node("tripod", parent);
    file.at(node).camera = static_cast<int>(file.model.cameras.size()) - 1;
    file.at(node).translation = place;
    return node;
}

/// The triangle (0,0,0) (1,0,0) (0,1,0), and two cameras 2 units before it: of 90 degrees, and parallel, 4 units high.
/// Both see it in the upper right of their middle, a quarter of the picture wide.
ModelBuilder triangleFile()
{
    ModelBuilder file;
    file.node("leaf", -1, file.triangle());
    cameraNode(file, "wide", "perspective", osg::PI_2, {0.0, 0.0, 2.0});
    cameraNode(file, "", "orthographic", 2.0, {0.0, 0.0, 2.0});
    return file;
}

ImportOptions with(const std::string& camera)
{
    ImportOptions options;
    options.camera = camera;
    return options;
}

class CamerasGLTest : public ViewerGLTest
{
protected:
    /// A viewer as osgviewer has it.
    void SetUp() override
    {
        ViewerGLTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> keys = new osgGA::KeySwitchMatrixManipulator;
        keys->addMatrixManipulator('1', "Trackball", new osgGA::TrackballManipulator);
        viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
        viewer().setCameraManipulator(keys);
    }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* scene, const std::vector<double>& times = {0.0})
    {
        const osg::ref_ptr<osg::Image> taken = ViewerGLTest::pictureOf(scene, times);
        EXPECT_NO_GL_ERROR();
        return taken;
    }

    /// True if the triangle is where both cameras of triangleFile() see it.
    static bool showsTriangle(const osg::Image& picture)
    {
        const osg::Vec4 background = picture.getColor(0u, 0u);
        const std::tuple<unsigned int, unsigned int, bool> places[] = {
            {34, 34, true},  {45, 33, true},  {33, 45, true},  {50, 33, false},
            {33, 50, false}, {45, 45, false}, {28, 34, false}, {34, 28, false}};
        for (const auto& [x, y, isInside] : places)
            if ((picture.getColor(x, y) != background) != isInside) return false;
        return true;
    }

    osg::Vec3d eye() { return osg::Matrixd::inverse(viewer().getCamera()->getViewMatrix()).getTrans(); }
};

} // namespace

TEST_F(CamerasGLTest, aViewerStartsWithTheChosenCameraAlsoFromStoredScenes)
{
    const StoredScene files;
    for (const bool isYUp : {true, false})
        for (const char* camera : {"0", "1", "tripod", "wide"})
        {
            ImportOptions options = with(camera);
            options.noRotation = isYUp;
            viewer().getCameraManipulator()->setAutoComputeHomePosition(true);
            const ImportedModel model = imported(triangleFile(), options);
            EXPECT_TRUE(showsTriangle(*pictureOf(model.root))) << camera;
            for (const char* format : {"osgb", "osgt", "osgx"})
            {
                if (isYUp) continue;
                const osg::ref_ptr<osg::Node> stored = files.throughFile(*model.root, format);
                ASSERT_TRUE(stored) << format;
                EXPECT_TRUE(showsTriangle(*pictureOf(stored))) << camera << " in " << format;
            }
        }
    // It is the manipulator's home.
    viewer().getCameraManipulator()->setByMatrix(osg::Matrixd::translate(0, 0, 50));
    drawAt(0.1);
    EXPECT_FALSE(showsTriangle(picture().image()));
    viewer().getEventQueue()->keyPress(' ');
    drawAt(0.2);
    EXPECT_TRUE(showsTriangle(picture().image()));
}

// The camera slides by one unit along X in one second, and is never a frame late.
TEST_F(CamerasGLTest, aMovingCameraIsFollowedUntilTheMouseIsUsed)
{
    ModelBuilder file = triangleFile();
    const int cart = file.node("cart");
    cameraNode(file, "ride", "perspective", 1.0, {0.0, 0.0, 3.0}, cart);
    file.slidingClip("go", cart);
    viewer().unref_nodelete(); // like osgviewer's, which is on the stack: nobody holds it
    for (const bool isScrolled : {false, true})
    {
        SCOPED_TRACE(isScrolled ? "scrolled" : "pressed");
        const ImportedModel model = imported(file, with("ride"));
        pictureOf(model.root, {0.0, 0.25});
        EXPECT_NEAR((eye() - osg::Vec3d(0.25, -3.0, 0.0)).length(), 0.0, 1e-5);
        drawAt(0.5);
        EXPECT_NEAR((eye() - osg::Vec3d(0.5, -3.0, 0.0)).length(), 0.0, 1e-5);
        if (isScrolled)
            viewer().getEventQueue()->mouseScroll(osgGA::GUIEventAdapter::SCROLL_UP);
        else
        {
            viewer().getEventQueue()->mouseButtonPress(32, 32, 1);
            viewer().getEventQueue()->mouseButtonRelease(32, 32, 1);
        }
        drawAt(0.75);
        EXPECT_NEAR(eye().x(), 0.5, 1e-5);
        EXPECT_NEAR(eye().y(), -3.0, isScrolled ? 1.0 : 1e-5) << "the manipulator zooms";
        viewer().getEventQueue()->keyPress(' ');
        drawAt(0.875);
        EXPECT_NEAR((eye() - osg::Vec3d(0.875, -3.0, 0.0)).length(), 0.0, 1e-5);
    }
    viewer().ref();
}

TEST_F(CamerasGLTest, withoutTheOptionAndWithoutAManipulatorNothingHappens)
{
    pictureOf(imported(triangleFile()).root);
    EXPECT_TRUE(viewer().getCameraManipulator()->getAutoComputeHomePosition());
    viewer().setCameraManipulator(nullptr);
    const osg::Matrixd before = viewer().getCamera()->getViewMatrix();
    pictureOf(imported(triangleFile(), with("wide")).root);
    EXPECT_EQ(viewer().getCamera()->getViewMatrix(), before);
}

TEST(CamerasTest, viewsHaveTheFilesNumbersAndNames)
{
    ModelBuilder file = triangleFile();
    const int second = file.node("second"), unnamed = file.node("");
    file.at(second).camera = 0;
    file.at(unnamed).camera = 1;
    const ImportedModel model = imported(file);
    const char* const names[] = {"wide", "tripod", "wide 2", "camera 1"};
    ASSERT_EQ(model.cameras.size(), std::size(names));
    for (std::size_t i = 0; i < std::size(names); ++i)
        EXPECT_EQ(model.cameras[i].view->getName(), names[i]);
    const osg::CameraView& wide = *model.cameras[0].view;
    EXPECT_EQ(wide.getFieldOfView(), 90.0);
    EXPECT_EQ(wide.getFieldOfViewMode(), osg::CameraView::VERTICAL);
    const osg::CameraView& parallel = *model.cameras[1].view;
    double height = 0.0;
    EXPECT_EQ(parallel.getFieldOfViewMode(), osg::CameraView::UNCONSTRAINED);
    EXPECT_TRUE(parallel.getUserValue(orthographicHeightName, height));
    EXPECT_EQ(height, 4.0);
    EXPECT_FALSE(model.startCamera);
    EXPECT_EQ(imported(file, with("wide 2")).startCamera->getName(), "wide 2");
}

// A camera's name counts more than its number, which is that of the file, not of the scene.
TEST(CamerasTest, areChosenByNameThenByTheFilesNumber)
{
    ModelBuilder file;
    for (const char* name : {"unused", "3", "film", "plan"})
        cameraNode(file, name, "perspective", 0.5, {});
    file.node("stone", -1, file.triangle());
    file.at(0).camera = 2;
    file.at(1).camera = 3;
    file.at(2).camera = 1;
    file.at(3).camera = -1;
    const std::pair<const char*, const char*> cases[] = {{"film", "film"}, {"3", "3"}, {"2", "film"}, {"1", "3"}};
    for (const auto& [wish, expected] : cases)
        EXPECT_EQ(imported(file, with(wish)).startCamera->getName(), expected) << wish;
    for (const bool noCameras : {false, true})
        for (const char* wish : {"0", "4", "narrow"})
        {
            ImportOptions options = with(wish);
            options.noCameras = noCameras;
            expectRefused(file.text(),
                          "camera \"" + std::string(wish) + "\" was asked for; the scene's cameras are: " +
                              (noCameras ? "none" : "\"film\", \"plan\", \"3\""),
                          options);
        }
}

} // namespace osgGpuAnimation::gltf
