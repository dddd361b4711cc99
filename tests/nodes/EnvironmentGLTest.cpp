// SPDX-License-Identifier: MIT
#include "nodes/GlCallTrace.h"
#include "nodes/StudioPanorama.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/environment/PrefilteredMap.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/FrontFace>
#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/MatrixTransform>

#include <algorithm>
#include <map>
#include <string>

namespace osgGpuAnimation
{

namespace
{

/// A ball of that material, 64 x 32 quads.
osg::ref_ptr<osg::Node> makeBall(float metallic, float roughness)
{
    constexpr unsigned int columns = 64, rows = 32;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (unsigned int row = 0; row <= rows; ++row)
        for (unsigned int column = 0; column <= columns; ++column)
        {
            const double latitude = osg::PI * (row / double(rows) - 0.5), longitude = 2 * osg::PI * column / columns;
            normals->push_back(osg::Vec3d(std::cos(latitude) * std::cos(longitude),
                                          std::cos(latitude) * std::sin(longitude), std::sin(latitude)));
            positions->push_back(normals->back() * 1.15f);
            if (row == rows || column == columns) continue;
            const unsigned int corner = row * (columns + 1) + column, above = corner + columns + 1;
            for (const unsigned int index : {corner, corner + 1, above + 1, corner, above + 1, above})
                triangles->push_back(static_cast<GLushort>(index));
        }
    osg::ref_ptr<osg::Geometry> ball = new osg::Geometry;
    ball->setUseVertexBufferObjects(true);
    ball->setVertexArray(positions);
    ball->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    ball->addPrimitiveSet(triangles);
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

    /// The surroundings show half the studio, so that highlights are not cut off.
    template <typename Source>
    osg::ref_ptr<osg::Image> pictureWith(Source* source, float intensity = 0.5f, float rotation = 0.0f)
    {
        const osg::ref_ptr<Environment> environment = new Environment;
        set(*environment, source);
        environment->setIntensity(intensity);
        environment->setRotation(rotation);
        return pictureIn(environment);
    }

private:
    static void set(Environment& environment, osg::Image* panorama) { EXPECT_TRUE(environment.setPanorama(panorama)); }
    static void set(Environment& environment, osg::TextureCubeMap* faces) { EXPECT_TRUE(environment.setFaces(faces)); }
};

TEST_F(EnvironmentGLTest, picturesOfTheStudioLightLikeTheStudio)
{
    const osg::ref_ptr<Environment> studio = new Environment;
    studio->setIntensity(0.5f);
    const osg::ref_ptr<osg::Image> expected = pictureIn(studio);
    // The studio's lobes are widened in closed form, those of pictures by sampling.
    EXPECT_LT(Picture::meanDifference(*expected, *pictureWith(makePanorama(1024, studioRadiance).get())), 0.012);
    EXPECT_LT(Picture::meanDifference(*expected, *pictureWith(makeFaces(128, studioRadiance).get())), 0.012);
    EXPECT_GT(Picture::meanDifference(*expected, *pictureWith(makePanorama(1024, studioRadiance).get(), 0.5f, 1.0f)),
              0.03);
}

// In the direction of normal and eye GGX spreads a small light over 4 pi alpha^2, alpha the square of the roughness,
// and directions count by their cosine. A rough white metal reflects 65 to 80 % at once.
TEST_F(EnvironmentGLTest, aMetalSpreadsASmallLightByItsRoughness)
{
    constexpr double sharpness = 1000.0, strength = 12.0; // a solid angle of 2 pi / 1000
    const auto spot = [](const osg::Vec3f& d)
    {
        const double light = strength * std::exp(sharpness * (static_cast<double>(d.z()) - 1.0));
        return osg::Vec3f(1, 1, 1) * static_cast<float>(light);
    };
    const osg::ref_ptr<Environment> environment = new Environment;
    ASSERT_TRUE(environment->setPanorama(makePanorama(512, spot)));
    environment->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    for (const double roughness : {0.4, 0.6})
    {
        const double square = std::pow(roughness, 4.0), rest = 1.0 - square; // alpha squared
        const double meanCosine = 2.0 / rest + 2.0 * square / (rest * rest) * std::log(square) - 1.0;
        const double radiance = strength / (2.0 * sharpness * square * meanCosine);
        environment->removeChildren(0, environment->getNumChildren());
        environment->addChild(makeBall(1.0f, static_cast<float>(roughness)));
        const auto found = static_cast<double>(linearColor(pictureIn(environment)->getColor(96, 96)).g());
        EXPECT_NEAR(found / radiance, 0.7, 0.1) << roughness;
    }
}

// Counter-clockwise from above: what is on the right, -Y as seen from the middle towards +X, comes to the middle.
TEST_F(EnvironmentGLTest, rotationTurnsThePicture)
{
    const auto turned = [](const osg::Vec3f& d) { return studioRadiance(osg::Vec3f(-d.z(), d.y(), d.x())); };
    const osg::ref_ptr<osg::Image> expected = pictureWith(makePanorama(512, turned).get());
    const osg::ref_ptr<osg::Image> panorama = makePanorama(512, studioRadiance);
    EXPECT_LT(Picture::meanDifference(*expected, *pictureWith(panorama.get(), 0.5f, osg::PI_2f)), 0.004);
    EXPECT_GT(Picture::meanDifference(*expected, *pictureWith(panorama.get(), 0.5f, -osg::PI_2f)), 0.03);
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

TEST_F(EnvironmentGLTest, intensityScalesThePicture)
{
    const auto half = [](const osg::Vec3f& d) { return studioRadiance(d) * 0.5f; };
    const osg::ref_ptr<osg::Image> expected = pictureWith(makePanorama(256, studioRadiance).get(), 0.4f);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(makePanorama(256, half).get(), 0.8f), 0.01f), 0);
    EXPECT_GT(Picture::pixelsDifferent(*expected, *pictureWith(makePanorama(256, half).get(), 0.4f), 0.01f), 5000);
}

TEST_F(EnvironmentGLTest, evenPicturesLightLikeEvenAmbientLight)
{
    const osg::ref_ptr<osg::Group> ambient = new osg::Group;
    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity(osg::Vec4(0.6f, 0.6f, 0.6f, 1.0f));
    ambient->getOrCreateStateSet()->setAttribute(model);
    const osg::ref_ptr<osg::Image> expected = pictureIn(ambient);
    const auto white = [](const osg::Vec3f&) { return osg::Vec3f(1, 1, 1); };
    const osg::ref_ptr<osg::Image> bytes = new osg::Image;
    bytes->allocateImage(4, 2, 1, GL_LUMINANCE, GL_UNSIGNED_BYTE, 1);
    std::fill_n(bytes->data(), 8, static_cast<unsigned char>(255));
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(makePanorama(64, white).get(), 0.6f), 0.005f), 0);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(makeFaces(8, white).get(), 0.6f), 0.005f), 0);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureWith(bytes.get(), 0.6f), 0.005f), 0);
}

// What is shown of a copy, and after another source; of a picture wider than it is read, and at its seam.
TEST_F(EnvironmentGLTest, copiesAndTheNextSourceAreShown)
{
    const osg::ref_ptr<Environment> environment = new Environment, studio = new Environment;
    const osg::ref_ptr<osg::Image> ofStudio = pictureIn(studio);
    ASSERT_TRUE(environment->setPanorama(makePanorama(64, [](const osg::Vec3f&) { return osg::Vec3f(0.2f, 0, 0); })));
    const osg::ref_ptr<osg::Image> red = pictureIn(environment);
    EXPECT_GT(Picture::pixelsDifferent(*ofStudio, *red), 5000);
    const osg::ref_ptr<Environment> copy = new Environment(*environment);
    environment->setStudio();
    EXPECT_EQ(Picture::pixelsDifferent(*ofStudio, *pictureIn(environment), 0.005f), 0);
    EXPECT_EQ(Picture::pixelsDifferent(*red, *pictureIn(copy), 0.005f), 0) << "the copy keeps its own";
}

TEST_F(EnvironmentGLTest, theInnerOfTwoEnvironmentsCounts)
{
    const osg::ref_ptr<Environment> outer = new Environment, inner = new Environment, alone = new Environment;
    ASSERT_TRUE(outer->setPanorama(makePanorama(64, [](const osg::Vec3f&) { return osg::Vec3f(1, 0, 0); })));
    addBalls(*inner);
    outer->addChild(inner);
    EXPECT_EQ(Picture::pixelsDifferent(*pictureIn(alone), *pictureIn(outer), 0.005f), 0);
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
        if (name.compare(0, 5, "glGet") == 0 || name == "glReadPixels" || name == "glFinish")
            ADD_FAILURE() << name << " is called " << count << " times in a frame";
}

TEST_F(EnvironmentGLTest, surroundingsSurviveTheReleaseOfTheirGlObjectsAndMoveToAnotherContext)
{
    const osg::ref_ptr<Environment> environment = new Environment;
    ASSERT_TRUE(environment->setPanorama(makePanorama(64, studioRadiance)));
    const osg::ref_ptr<osg::Image> expected = pictureIn(environment);
    environment->releaseGLObjects(&state());
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureIn(environment), 0.005f), 0);
    environment->resizeGLObjectBuffers(16);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureIn(environment), 0.005f), 0);
    TearDown();
    SetUp();
    EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureIn(environment), 0.005f), 0);
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
        std::map<std::string, std::vector<GLint>> found;
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
                                                        {"depth test", GL_DEPTH_TEST},
                                                        {"blend", GL_BLEND},
                                                        {"scissor test", GL_SCISSOR_TEST},
                                                        {"cull face", GL_CULL_FACE},
                                                        {"clip plane", GL_CLIP_PLANE0},
                                                        {"logic op", GL_COLOR_LOGIC_OP},
                                                        {"seamless", 0x884F}}; // GL_TEXTURE_CUBE_MAP_SEAMLESS
        for (const auto& [name, value] : names)
        {
            found[name].assign(4, -1);
            glGetIntegerv(value, found[name].data());
        }
        return found;
    }

    void spoilState()
    {
        for (const GLenum mode : {GL_DEPTH_TEST, GL_BLEND, GL_SCISSOR_TEST, GL_CULL_FACE, GL_COLOR_LOGIC_OP})
            glEnable(mode);
        glEnable(GL_CLIP_PLANE0);
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
