// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "serializers/StoredScene.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <gtest/gtest.h>
#include <osg/Math>
#include <osg/ValueObject>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgGA/TrackballManipulator>
#include <osgUtil/Optimizer>

#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace osgGpuAnimation::gltf
{

// Pictures of a wall of 8 by 8 units, lit by the file's own lights. A light of glTF shines along its node's -Z, which
// is towards the wall.

namespace
{

tinygltf::Light light(const std::string& type, const std::string& name = "")
{
    tinygltf::Light made;
    made.type = type;
    made.name = name;
    made.color = {1.0, 0.5, 0.25};
    made.intensity = 3.0;
    return made;
}

const PunctualLight& lightOf(const ImportedLight& imported)
{
    return dynamic_cast<const PunctualLight&>(*imported.source->getLight());
}

/// A triangle and three lights.
ModelBuilder threeLights()
{
    ModelBuilder file;
    file.node("leaf", -1, file.triangle());
    file.lamp(light("directional"), "sun node");
    tinygltf::Light bulb = light("point", "bulb"), torch = light("spot", "torch");
    bulb.range = 7.0;
    file.lamp(bulb, "", {1.0, 0.0, 0.0});
    torch.spot.innerConeAngle = osg::PI / 12.0;
    torch.spot.outerConeAngle = osg::PI / 6.0;
    file.lamp(torch, "", {2.0, 0.0, 0.0});
    return file;
}

const double pi = osg::PI;

tinygltf::Light whiteLight(const std::string& type, double intensity)
{
    tinygltf::Light made = light(type);
    made.intensity = intensity;
    made.color = {1.0, 1.0, 1.0};
    return made;
}

/// The wall: many small squares, as the fixed pipeline lights vertices.
int wall(ModelBuilder& file)
{
    std::vector<float> positions, normals;
    for (int x = 0; x < 32; ++x)
        for (int y = 0; y < 32; ++y)
            for (const auto& [right, up] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}})
            {
                const auto place = [](int step) { return 0.25f * static_cast<float>(step) - 4.0f; };
                positions.insert(positions.end(), {place(x + right), place(y + up), 0});
                normals.insert(normals.end(), {0, 0, 1});
            }
    return file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, positions)},
                      {"NORMAL", file.floats(TINYGLTF_TYPE_VEC3, normals)}});
}

/// The wall, still or drawn from the palette.
ModelBuilder wallFile(bool isMoving = false)
{
    ModelBuilder file;
    const int node = file.node("wall", -1, wall(file));
    if (isMoving) file.animation("hold");
    if (isMoving) file.channel(node, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 0, 0});
    return file;
}

class LightsGLTest : public ViewerGLTest
{
protected:
    /// With GL's lighting, and no light but the scene's.
    osg::ref_ptr<osg::Image> pictureOf(osg::Node* scene, const std::vector<double>& times = {0.0})
    {
        viewer().setLightingMode(osg::View::NO_LIGHT);
        viewer().getCamera()->setViewMatrixAsLookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
        osg::ref_ptr<osg::Group> group = new osg::Group;
        group->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        group->addChild(scene);
        const osg::ref_ptr<osg::Image> taken = ViewerGLTest::pictureOf(group, times);
        EXPECT_NO_GL_ERROR();
        return taken;
    }

    static ImportedModel model(const ModelBuilder& file)
    {
        ImportOptions options;
        options.noRotation = true;
        return imported(file, options);
    }

    osg::ref_ptr<osg::Image> pictureOf(const ModelBuilder& file) { return pictureOf(model(file).root); }

    /// The red of the wall's point.
    static float at(const osg::Image& image, double x, double y)
    {
        const auto pixel = [&](double place) { return static_cast<unsigned int>((place + 4.0) * 8.0); };
        return image.getColor(pixel(x), pixel(y)).x();
    }

    StoredScene files;
};

} // namespace

TEST(LightsTest, lightsAreOpenGLsFromSevenDown)
{
    ModelBuilder file = threeLights();
    file.lamp(0, "second sun");
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.lights.size(), 4u);
    const PunctualLight::Kind kinds[] = {PunctualLight::Kind::Directional, PunctualLight::Kind::Point,
                                         PunctualLight::Kind::Spot, PunctualLight::Kind::Directional};
    const char* const names[] = {"sun node", "bulb", "torch", "second sun"};
    for (int i = 0; i < 4; ++i)
    {
        const PunctualLight& made = lightOf(model.lights[static_cast<std::size_t>(i)]);
        EXPECT_EQ(made.getLightNum(), 7 - i); // applications begin at 0
        EXPECT_EQ(made.getKind(), kinds[i]);
        EXPECT_EQ(made.getName(), names[i]);
        EXPECT_NEAR(made.getDiffuse().y(), 1.5 / osg::PI, 1e-6);
        EXPECT_EQ(model.root->getStateSet()->getMode(GL_LIGHT7 - static_cast<unsigned int>(i)),
                  osg::StateAttribute::GLModeValue(osg::StateAttribute::ON));
    }
    EXPECT_EQ(model.lights[3].light, 0);
    EXPECT_EQ(lightOf(model.lights[1]).getRange(), 7.0f);
    EXPECT_NEAR(lightOf(model.lights[2]).getInnerConeAngle(), 15.0f, 1e-4f);
    EXPECT_NEAR(lightOf(model.lights[2]).getSpotCutoff(), 30.0f, 1e-4f);
    expectWarnings(model, {});
    EXPECT_TRUE(model.messages.notes.empty());
}

TEST(LightsTest, lightsDoNotCountForTheScenesBounds)
{
    ModelBuilder file = threeLights();
    file.lamp(light("point"), "far", {1e6, 0.0, 0.0});
    ImportOptions without;
    without.noLights = true;
    const ImportedModel model = imported(file), dark = imported(file, without);
    EXPECT_EQ(model.root->getBound().radius(), dark.root->getBound().radius());
    EXPECT_TRUE(dark.lights.empty());
    EXPECT_FALSE(dark.root->getStateSet());
}

// Nearest to the middle of the drawn meshes, in the file's axes, numbered in the file's order.
TEST(LightsTest, ofManyTheNearestSevenAndTheSunRemain)
{
    ModelBuilder file;
    file.at(file.node("leaf", -1, file.triangle())).translation = {0.0, 50.0, 0.0};
    file.lamp(light("point", "near in the turned scene"), "", {0.0, 0.0, 50.0});
    file.lamp(light("directional", "sun"), "", {0.0, -1e5, 0.0});
    for (int y = 90; y >= 0; y -= 10)
        file.lamp(light("point", std::to_string(y)), "", {0.0, static_cast<double>(y), 0.0});
    const ImportedModel model = imported(file);
    std::string kept;
    int number = 7;
    for (const ImportedLight& made : model.lights)
    {
        if (!made.source) continue;
        kept += made.source->getName() + ' ';
        EXPECT_EQ(lightOf(made).getLightNum(), number--);
    }
    EXPECT_EQ(kept, "sun 80 70 60 50 40 30 ");
    expectWarnings(model, {"12 lights, OpenGL has 7"});
}

TEST(LightsTest, aLightBeyondFloatNumbersIsLeftOut)
{
    ModelBuilder file = threeLights();
    file.model.lights[0].color = {1e30, 1.0, 1.0};
    file.model.lights[0].intensity = 1e30;
    const ImportedModel model = imported(file);
    expectWarnings(model, {"lights[0]: a light's color or intensity"});
    EXPECT_FALSE(model.lights[0].source);
    EXPECT_EQ(lightOf(model.lights[1]).getLightNum(), 7);
}

// An application may give a light values that glTF has no name for: the scene stays readable.
TEST(LightsTest, storedLightsHaveAllTheirValues)
{
    const StoredScene files;
    for (const bool isWider : {false, true})
        for (const ImportedLight& made : imported(threeLights()).lights)
        {
            osg::Light& light = *made.source->getLight();
            if (isWider && lightOf(made).getKind() != PunctualLight::Kind::Spot) continue;
            if (isWider) light.setSpotCutoff(120.0f);
            light.setSpotExponent(7.0f);
            for (const char* format : {"osgb", "osgt", "osgx"})
            {
                const osg::ref_ptr<osg::Node> stored = files.throughFile(*made.source, format);
                const auto* source = dynamic_cast<const osg::LightSource*>(stored.get());
                ASSERT_TRUE(source && source->getLight()) << format;
                EXPECT_EQ(source->getLight()->getSpotCutoff(), light.getSpotCutoff()) << format;
                EXPECT_EQ(source->getLight()->getDiffuse(), light.getDiffuse()) << format;
                EXPECT_TRUE(isWider || source->getLight()->compare(light) == 0) << format;
                EXPECT_FALSE(source->getBound().valid()) << format;
            }
        }
}

// The light is below a node that is no joint, below an animated one: where the node above is, to the left or right.
TEST_F(LightsGLTest, aLightMovesWithItsNodeAndInCopiesToo)
{
    ModelBuilder file = wallFile();
    const int arm = file.node("arm");
    file.lamp(whiteLight("point", pi), "lamp", {-2.0, 0.0, 1.0}, arm);
    file.animation("swing");
    file.channel(arm, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 4, 0, 0});
    const ImportedModel made = model(file);
    ASSERT_EQ(made.lights.size(), 1u);
    const osg::ref_ptr<osg::Node> copy = osg::clone(made.root.get(), osg::CopyOp::DEEP_COPY_NODES);
    osg::ref_ptr<osg::Image> expected;
    for (osg::Node* scene : {static_cast<osg::Node*>(made.root.get()), copy.get()})
    {
        const osg::ref_ptr<osg::Image> before = pictureOf(scene, {0.0});
        const osg::ref_ptr<osg::Image> after = pictureOf(scene, {0.0, 0.999});
        EXPECT_GT(at(*before, -2.0, 0.0), at(*before, 2.0, 0.0) + 0.2f);
        EXPECT_GT(at(*after, 2.0, 0.0), at(*after, -2.0, 0.0) + 0.2f);
        if (expected)
        {
            EXPECT_EQ(Picture::pixelsDifferent(*after, *expected), 0);
        }
        expected = after;
    }
}

TEST_F(LightsGLTest, onlyTheFilesModelIsLitAndByLightsOutsideTheViewToo)
{
    ModelBuilder dark = wallFile(), sunny = wallFile(true);
    sunny.lamp(whiteLight("directional", 0.5 * pi), "lamp", {500.0, 0.0, 0.0});
    const osg::ref_ptr<osg::Image> alone = pictureOf(dark);
    EXPECT_GT(at(*pictureOf(sunny), 0.0, 0.0), at(*alone, 0.0, 0.0) + 0.2f);
    sunny.at(0).translation = {100.0, 0.0, 0.0};
    sunny.model.animations.clear();
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(model(dark).root);
    both->addChild(model(sunny).root);
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(both.get()), *alone), 0);
}

// What applications do to a scene: the Optimizer, and files in OSG's own formats.
TEST_F(LightsGLTest, lightsStayWhereTheyAreThroughToolsAndFiles)
{
    ModelBuilder file = wallFile();
    const int tower = file.node("tower");
    file.at(tower).translation = {1.0, 1.0, 0.0};
    file.at(tower).rotation = {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};
    file.node("roof", tower, file.triangle());
    tinygltf::Light lamp = whiteLight("spot", 8.0 * pi);
    lamp.range = 6.0;
    lamp.spot.innerConeAngle = 0.2;
    lamp.spot.outerConeAngle = 0.4;
    // The Optimizer must not flatten its transform into the mesh.
    file.at(file.lamp(lamp, "lamp", {-2.0, 0.0, 4.0}, tower)).mesh = file.triangle();
    const osg::ref_ptr<osg::Image> expected = pictureOf(file);
    EXPECT_GT(at(*expected, 1.0, -1.0), at(*expected, -2.0, -1.0) + 0.2f);

    const ImportedModel optimized = model(file);
    osgUtil::Optimizer().optimize(optimized.root);
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(optimized.root.get()), *expected), 0) << "optimized";
    for (const char* format : {"osgb", "osgt", "osgx"})
    {
        const osg::ref_ptr<osg::Node> stored = files.throughFile(*model(file).root, format);
        ASSERT_TRUE(stored) << format;
        EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(stored.get()), *expected), 0) << format;
    }
}

// Views through the file's own cameras, as osgviewer would have them at its first frame.

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
