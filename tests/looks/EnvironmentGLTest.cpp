// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "looks/StudioPanorama.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/environment/PrefilteredMap.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/ClipPlane>
#include <osg/FrontFace>
#include <osg/LightModel>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>

#include <algorithm>
#include <functional>
#include <map>
#include <string>

namespace osgGpuAnimation
{

namespace
{

osg::ref_ptr<osg::Node> makeBall(float metallic, float roughness)
{
    const osg::ref_ptr<osg::TessellationHints> fine = new osg::TessellationHints;
    fine->setDetailRatio(1.6f);
    osg::ref_ptr<osg::ShapeDrawable> ball = new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(0, 0, 0), 1.15f), fine);
    ball->setColorArray(nullptr);
    PbrMaterial material;
    material.metallic = metallic;
    material.roughness = roughness;
    applyPbrMaterial(*ball->getOrCreateStateSet(), material);
    applySurfaceProgram(*ball->getOrCreateStateSet(), false);
    return ball;
}

/// Puts white balls into the group: above metal, below not, rougher to the right.
void addBalls(osg::Group& group)
{
    for (const float metallic : {0.0f, 1.0f})
        for (int column = 0; column < 3; ++column)
        {
            osg::ref_ptr<osg::MatrixTransform> place =
                new osg::MatrixTransform(osg::Matrix::translate(2.6 * (column - 1), 0, metallic > 0.0f ? 1.4 : -1.4));
            place->addChild(makeBall(metallic, 0.15f + 0.4f * static_cast<float>(column)));
            group.addChild(place);
        }
    group.getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
}

/// Balls in surroundings, without a light of OSG's.
class EnvironmentGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 192; }

    osg::ref_ptr<osg::Image> pictureIn(osg::Group* surroundings)
    {
        if (surroundings->getNumChildren() == 0) addBalls(*surroundings);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        viewer().getCamera()->setClearColor(osg::Vec4(0, 0, 0.2f, 1));
        return pictureOf(surroundings, {0.0});
    }

    /// At half the intensity, so that highlights are not cut off.
    osg::ref_ptr<osg::Image> pictureWith(osg::Image* panorama, float rotation = 0.0f)
    {
        const osg::ref_ptr<Environment> environment = new Environment;
        EXPECT_TRUE(!panorama || environment->setPanorama(panorama));
        environment->setIntensity(0.5f);
        environment->setRotation(rotation);
        return pictureIn(environment);
    }
    osg::ref_ptr<osg::Image> pictureWith(osg::TextureCubeMap* faces)
    {
        const osg::ref_ptr<Environment> environment = new Environment;
        EXPECT_TRUE(environment->setFaces(faces));
        environment->setIntensity(0.5f);
        return pictureIn(environment);
    }
};

TEST_F(EnvironmentGLTest, picturesOfTheStudioLightLikeTheStudio)
{
    constexpr osg::Image* none = nullptr;
    const osg::ref_ptr<osg::Image> panorama = makePanorama(1024, studioRadiance);
    const osg::ref_ptr<osg::Image> expected = pictureWith(none), turned = pictureWith(none, 1.0f);
    // The studio's lobes are widened in closed form, those of pictures by sampling.
    EXPECT_LT(Picture::meanDifference(*expected, *pictureWith(panorama.get())), 0.012);
    EXPECT_LT(Picture::meanDifference(*expected, *pictureWith(makeFaces(128, studioRadiance).get())), 0.012);
    EXPECT_LT(Picture::meanDifference(*turned, *pictureWith(panorama.get(), 1.0f)), 0.012);
    EXPECT_GT(Picture::meanDifference(*expected, *turned), 0.03);
}

// Counter-clockwise from above: what is on the right, -Y as seen from the middle towards +X, comes to the middle.
TEST_F(EnvironmentGLTest, rotationTurnsThePicture)
{
    const auto turned = [](const osg::Vec3f& d) { return studioRadiance(osg::Vec3f(-d.z(), d.y(), d.x())); };
    const osg::ref_ptr<osg::Image> expected = pictureWith(makePanorama(512, turned).get());
    const osg::ref_ptr<osg::Image> panorama = makePanorama(512, studioRadiance);
    EXPECT_LT(Picture::meanDifference(*expected, *pictureWith(panorama.get(), osg::PI_2f)), 0.004);
    EXPECT_GT(Picture::meanDifference(*expected, *pictureWith(panorama.get(), -osg::PI_2f)), 0.03);
}

// A node above that mirrors mirrors model and surroundings alike.
TEST_F(EnvironmentGLTest, theMirroredSceneIsTheMirrorImage)
{
    osg::ref_ptr<osg::Image> pictures[2];
    for (const bool isMirrored : {false, true})
    {
        const osg::ref_ptr<Environment> environment = new Environment;
        environment->setIntensity(0.5f);
        addBalls(*environment);
        const osg::ref_ptr<osg::MatrixTransform> above =
            new osg::MatrixTransform(osg::Matrix::scale(isMirrored ? -1 : 1, 1, 1));
        above->addChild(environment);
        if (isMirrored)
            above->getOrCreateStateSet()->setAttributeAndModes(new osg::FrontFace(osg::FrontFace::CLOCKWISE));
        pictures[isMirrored ? 1 : 0] = pictureIn(above);
    }
    EXPECT_GT(Picture::pixelsDifferent(*pictures[0], *pictures[1]), 1000);
    pictures[1]->flipHorizontal();
    EXPECT_LT(Picture::pixelsDifferent(*pictures[0], *pictures[1]), 200) << "edges of the balls";
}

TEST_F(EnvironmentGLTest, evenPicturesLightLikeEvenAmbientLight)
{
    const osg::ref_ptr<osg::Group> ambient = new osg::Group;
    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity(osg::Vec4(0.5f, 0.5f, 0.5f, 1.0f));
    ambient->getOrCreateStateSet()->setAttribute(model);
    const osg::ref_ptr<osg::Image> expected = pictureIn(ambient);
    const auto white = [](const osg::Vec3f&) { return osg::Vec3f(1, 1, 1); };
    const osg::ref_ptr<osg::Image> bytes = new osg::Image;
    bytes->allocateImage(4, 2, 1, GL_LUMINANCE, GL_UNSIGNED_BYTE, 1);
    std::fill_n(bytes->data(), 8, static_cast<unsigned char>(255));
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(makePanorama(64, white).get()), 0.005f), 0);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(makeFaces(8, white).get()), 0.005f), 0);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(bytes.get()), 0.005f), 0);
}

TEST_F(EnvironmentGLTest, copiesAndTheNextSourceAreShown)
{
    const osg::ref_ptr<Environment> environment = new Environment, studio = new Environment, outer = new Environment;
    const auto red = [](const osg::Vec3f& d) { return osg::Vec3f(3 + 2 * d.x(), 0, 0); };
    ASSERT_TRUE(environment->setFaces(makeFaces(4, studioRadiance)));
    ASSERT_TRUE(environment->setPanorama(makePanorama(64, red)));
    EXPECT_EQ(environment->getFaces(), nullptr);
    for (Environment* each : {environment.get(), studio.get()})
    {
        each->setIntensity(0.4f);
        each->setRotation(1.0f);
        each->setToneMapping(true);
    }
    const osg::ref_ptr<osg::Image> ofStudio = pictureIn(studio), ofRed = pictureIn(environment);
    EXPECT_GT(Picture::pixelsDifferent(*ofStudio, *ofRed), 5000);
    const osg::ref_ptr<Environment> copy = new Environment(*environment, osg::CopyOp::DEEP_COPY_ALL);
    environment->setStudio();
    EXPECT_EQ(environment->getPanorama(), nullptr);
    EXPECT_EQ(Picture::pixelsDifferent(*ofStudio, *pictureIn(environment), 0.005f), 0);
    EXPECT_EQ(Picture::pixelsDifferent(*ofRed, *pictureIn(copy), 0.005f), 0) << "the copy keeps its own";
    ASSERT_TRUE(outer->setPanorama(makePanorama(64, red)));
    outer->addChild(environment);
    EXPECT_EQ(Picture::pixelsDifferent(*ofStudio, *pictureIn(outer), 0.005f), 0) << "the inner of two counts";
}

TEST_F(EnvironmentGLTest, laterFramesAskNothingOfTheGpu)
{
    const osg::ref_ptr<Environment> environment = new Environment;
    ASSERT_TRUE(environment->setPanorama(makePanorama(64, studioRadiance)));
    pictureIn(environment);
    viewer().getCamera()->setFinalDrawCallback(nullptr);
    drawAt(0.1);
    const GlCallTrace trace(state());
    drawAt(0.2);
    for (const auto& [name, count] : trace.calls())
        EXPECT_TRUE(name.rfind("glGet", 0) != 0 && name != "glReadPixels" && name != "glFinish") << name << count;
}

TEST_F(EnvironmentGLTest, surroundingsSurviveTheReleaseOfTheirGlObjectsAndMoveToAnotherContext)
{
    const osg::ref_ptr<Environment> environment = new Environment;
    ASSERT_TRUE(environment->setPanorama(makePanorama(64, studioRadiance)));
    const osg::ref_ptr<osg::Image> expected = pictureIn(environment);
    const std::function<void()> changes[] = {[&] { environment->releaseGLObjects(&state()); },
                                             [&] { environment->resizeGLObjectBuffers(16); },
                                             [&] { TearDown(), SetUp(); }};
    for (const auto& change : changes)
    {
        change();
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureIn(environment), 0.005f), 0) << &change - changes;
    }
}

/// The map in a context of each profile, below state that would spoil its drawing.
class PrefilteredMapGLTest : public GLTest, public ::testing::WithParamInterface<bool>
{
protected:
    osg::ref_ptr<osg::GraphicsContext::Traits> traits() const override
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> wanted = GLTest::traits();
        wanted->glContextProfileMask = GetParam() ? 1 : 2;
        wanted->glContextVersion = "3.3";
        return wanted;
    }

    /// The state that drawing changes.
    static std::map<std::string, std::vector<GLint>> glState()
    {
        const std::pair<const char*, GLenum> names[] = {{"draw framebuffer", GL_DRAW_FRAMEBUFFER_BINDING_EXT},
                                                        {"read framebuffer", GL_READ_FRAMEBUFFER_BINDING_EXT},
                                                        {"vertex array", 0x85B5}, // GL_VERTEX_ARRAY_BINDING
                                                        {"program", GL_CURRENT_PROGRAM},
                                                        {"active texture", GL_ACTIVE_TEXTURE},
                                                        {"viewport", GL_VIEWPORT},
                                                        {"polygon mode", GL_POLYGON_MODE},
                                                        {"colour mask", GL_COLOR_WRITEMASK},
                                                        {"unpack alignment", GL_UNPACK_ALIGNMENT},
                                                        {"unpack row length", GL_UNPACK_ROW_LENGTH},
                                                        {"seamless", 0x884F}}; // GL_TEXTURE_CUBE_MAP_SEAMLESS
        std::map<std::string, std::vector<GLint>> found;
        for (const auto& [name, value] : names)
            glGetIntegerv(value, found.emplace(name, std::vector<GLint>(4, -1)).first->second.data());
        for (const GLenum mode : modes)
            found["modes"].push_back(glIsEnabled(mode));
        return found;
    }

    void spoilState()
    {
        for (const GLenum mode : modes)
            glEnable(mode);
        glDepthFunc(GL_NEVER);
        glBlendFunc(GL_ZERO, GL_ZERO);
        glScissor(0, 0, 1, 1);
        glCullFace(GL_FRONT_AND_BACK);
        glLogicOp(GL_CLEAR);
        glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
        glViewport(3, 4, 5, 6);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 77);
        osg::GLExtensions& gl = *state().get<osg::GLExtensions>();
        gl.glGenVertexArrays(1, &_vertexArray);
        gl.glBindVertexArray(_vertexArray);
        gl.glGenFramebuffers(1, &_framebuffer);
        gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, _framebuffer);
        gl.glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, 0);
    }

    void TearDown() override
    {
        if (!IsSkipped() && !HasFatalFailure())
        {
            osg::GLExtensions& gl = *state().get<osg::GLExtensions>();
            gl.glBindVertexArray(0);
            gl.glDeleteVertexArrays(1, &_vertexArray);
            gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, 0);
            gl.glDeleteFramebuffers(1, &_framebuffer);
        }
        GLTest::TearDown();
    }

private:
    static constexpr GLenum modes[] = {GL_DEPTH_TEST, GL_BLEND,          GL_SCISSOR_TEST,
                                       GL_CULL_FACE,  GL_COLOR_LOGIC_OP, GL_CLIP_PLANE0};
    GLuint _vertexArray = 0, _framebuffer = 0;
};

TEST_P(PrefilteredMapGLTest, theStateOfGlIsAsBeforeAndTheMapIsRight)
{
    const auto orange = [](const osg::Vec3f&) { return osg::Vec3f(2.0f, 1.0f, 0.5f); };
    const auto cube = RadianceCube::fromPanorama(*makePanorama(16, orange));
    ASSERT_TRUE(cube);
    const osg::ref_ptr<PrefilteredMap> map = new PrefilteredMap(*cube.value());
    takeGLErrors(); // an OSG with the fixed pipeline makes errors of its own in the core profile
    spoilState();
    state().setActiveTextureUnit(3);
    const auto before = glState();
    for (int round = 0; round < 2; ++round)
    {
        map->apply(state());
        const auto after = glState();
        for (const auto& [name, values] : before)
            EXPECT_EQ(after.at(name), values) << name << ", round " << round;
    }
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_CUBE_MAP, &bound);
    EXPECT_EQ(static_cast<GLuint>(bound), map->getTextureObject(state().getContextID())->id());
    for (int level = 0; level < PrefilteredMap::levels; ++level)
        for (GLenum face = 0; face < 6; ++face)
        {
            const auto side = static_cast<std::size_t>(RadianceCube::side >> level);
            std::vector<osg::Vec3f> pixels(side * side);
            glGetTexImage(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, level, GL_RGB, GL_FLOAT, pixels.data());
            float worst = 0.0f;
            for (const osg::Vec3f& pixel : pixels)
                worst = std::max(worst, static_cast<float>((pixel - osg::Vec3f(2.0f, 1.0f, 0.5f)).length()));
            EXPECT_LT(worst, 0.01f) << "level " << level << ", face " << face;
        }
    EXPECT_NO_GL_ERROR();
}

TEST_P(PrefilteredMapGLTest, belowOpenGL33TheMapIsBlack)
{
    const auto cube =
        RadianceCube::fromPanorama(*makePanorama(16, [](const osg::Vec3f&) { return osg::Vec3f(1, 1, 1); }));
    ASSERT_TRUE(cube);
    takeGLErrors();
    osg::GLExtensions& gl = *state().get<osg::GLExtensions>();
    const float version = gl.glVersion;
    gl.glVersion = 3.2f;
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 1000);
    const osg::ref_ptr<PrefilteredMap> map = new PrefilteredMap(*cube.value());
    map->apply(state());
    gl.glVersion = version;
    EXPECT_EQ(glState()["unpack row length"].front(), 1000);
    std::vector<float> pixels(static_cast<std::size_t>(RadianceCube::side * RadianceCube::side * 3), 1.0f);
    glGetTexImage(GL_TEXTURE_CUBE_MAP_POSITIVE_X, 0, GL_RGB, GL_FLOAT, pixels.data());
    EXPECT_EQ(std::count(pixels.begin(), pixels.end(), 0.0f), static_cast<std::ptrdiff_t>(pixels.size()));
    EXPECT_NO_GL_ERROR();
}

INSTANTIATE_TEST_SUITE_P(Profiles, PrefilteredMapGLTest, ::testing::Bool(),
                         [](const auto& info) { return std::string(info.param ? "core" : "compatibility"); });

} // namespace

} // namespace osgGpuAnimation
