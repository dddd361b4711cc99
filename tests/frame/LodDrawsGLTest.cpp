// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/Levels.h"
#include "support/PrimitiveCount.h"
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgShadow/LightSpacePerspectiveShadowMap>
#include <osgShadow/ParallelSplitShadowMap>
#include <osgShadow/ShadowedScene>
#include <osgShadow/ShadowMap>
#include <osgShadow/SoftShadowMap>
#include <osgShadow/StandardShadowMap>
#include <osgShadow/ViewDependentShadowMap>

#include <set>

namespace osgGpuAnimation
{

// Tests which meshes are drawn with fewer triangles, by the number of triangles in a frame.

namespace
{

constexpr float largeError = 100.0f; ///< selects the coarsest level of every mesh that has levels

class LodDrawsGLTest : public ViewerGLTest
{
protected:
    /// The number of triangles in the scene's second frame.
    GLuint trianglesOf(osg::Node& scene)
    {
        viewer().getCamera()->setProjectionMatrixAsOrtho(-20, 20, -20, 20, 1, 20);
        return trianglesDrawn(scene);
    }

    /// The same with the camera as it is.
    GLuint trianglesDrawn(osg::Node& scene)
    {
        waitForLevels(scene);
        _count->attach(*viewer().getCamera(), picture());
        pictureOf(&scene, {0.0, 0.1});
        return _count->primitives();
    }

private:
    osg::ref_ptr<PrimitiveCount> _count = new PrimitiveCount;
};

/// A mesh of that many vertices without triangles: it has no levels, and building them takes no time.
osg::ref_ptr<SkinnedGeometry> makeBlank(std::size_t vertices)
{
    const osg::ref_ptr<SkinnedGeometry> blank = new SkinnedGeometry;
    blank->setVertexArray(new osg::Vec3Array(static_cast<unsigned int>(vertices)));
    blank->setRigidEntry(0);
    return blank;
}

void fillUp(AnimatedCharacter& character)
{
    for (std::size_t vertices = 0; vertices < LodRange::maxVertices; vertices += LodLevels::maxVertices)
        character.addChild(makeBlank(LodLevels::maxVertices));
}

TEST_F(LodDrawsGLTest, whatComesAfterTheMostVerticesOrBelowOtherNodesIsDrawnWhole)
{
    const osg::ref_ptr<AnimatedCharacter> nested = makeTubeCharacter(armSet()), large = makeTubeCharacter(armSet());
    ASSERT_TRUE(large->getMeshes().setPixelError(largeError));
    EXPECT_LT(trianglesOf(*large), tubeTriangles / 4);
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(makeShownTube(nested->getAnimationSet()));
    nested->addChild(group);
    fillUp(*large);
    large->addChild(makeShownTube(large->getAnimationSet()));
    for (const auto& character : {nested, large})
        ASSERT_TRUE(character->getMeshes().setPixelError(largeError));
    for (const auto& scene : std::vector<osg::ref_ptr<osg::Node>>{nested, large, makeCrowd(*large)})
    {
        const GLuint triangles = trianglesOf(*scene);
        EXPECT_GE(triangles, tubeTriangles) << scene->className();
        EXPECT_LT(triangles, tubeTriangles + tubeTriangles / 4) << scene->className();
    }
}

// The nearest point of the sphere selects the level, not its centre.
TEST_F(LodDrawsGLTest, whatReachesBehindTheEyeIsDrawnWhole)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(armSet());
    ASSERT_TRUE(character->getMeshes().setPixelError(largeError));
    const osg::BoundingSphere bound = character->getBound(); // the crowd's instance has the same
    for (const auto& animated : std::vector<osg::ref_ptr<osg::Node>>{character, makeCrowd(*character)})
    {
        const auto trianglesAt = [&](double radii)
        {
            osg::Camera& camera = *viewer().getCamera();
            camera.setProjectionMatrixAsPerspective(60, 1, 0.01, 1000);
            const osg::Vec3d centre = bound.center();
            camera.setViewMatrixAsLookAt(centre - osg::Vec3d(0, radii * bound.radius(), 0), centre, {0, 0, 1});
            return trianglesDrawn(*animated);
        };
        EXPECT_EQ(trianglesAt(0.9), tubeTriangles) << animated->className();
        EXPECT_LT(trianglesAt(1.3), tubeTriangles / 4) << animated->className();
    }
}

// An error of the mesh grows with the largest scale of its placement, whatever way that scale points.
TEST_F(LodDrawsGLTest, aTurnDoesNotChangeTheLevel)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(armSet());
    std::set<GLuint> counts;
    for (const float error : {0.02f, 0.03f, 0.05f, 0.08f, 0.13f, 0.21f, 0.34f})
    {
        ASSERT_TRUE(character->getMeshes().setPixelError(error));
        std::vector<GLuint> triangles;
        for (const osg::Vec3d& towards : {osg::Vec3d(1, 0, 0), osg::Vec3d(1, 1, 1)})
        {
            const osg::Matrixd place = osg::Matrixd::scale(0.9, 0.1, 0.1) * osg::Matrixd::rotate({1, 0, 0}, towards);
            triangles.push_back(trianglesOf(*makeCrowd(*character, {place})));
        }
        EXPECT_EQ(triangles[0], triangles[1]) << error;
        counts.insert(triangles[0]);
    }
    EXPECT_GE(counts.size(), 3u);
}

TEST_F(LodDrawsGLTest, charactersOfASetHaveLevelsOfTheirOwnMeshes)
{
    const auto set = armSet();
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (int i = 0; i < 4; ++i)
    {
        const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(set);
        ASSERT_TRUE(character->getMeshes().setPixelError(largeError));
        // The mesh is set after setPixelError().
        character->setChild(0, makeShownTube(*set));
        if (i % 2 == 1) character->insertChild(0, makeBlank(1));
        scene->addChild(character);
    }
    EXPECT_LT(trianglesOf(*scene), tubeTriangles);
}

/// Far and near places in turn, whose tubes have levels of their own: three at each of 45, 90 and 270 units away.
osg::Matrixd placeAtDepth(int index)
{
    const double away = index % 3 == 0 ? 90.0 : index % 3 == 1 ? 45.0 : 270.0;
    return osg::Matrixd::translate((0.11 * (index / 3) - 0.2) * away, away - 10.0, (index % 3 - 1) * 0.16 * away);
}

// Characters share instanced draws by level: the first of a level is drawn alone, the others together.
TEST_F(LodDrawsGLTest, charactersThatAreDrawnTogetherHaveTheirOwnLevels)
{
    viewer().getCamera()->setProjectionMatrixAsPerspective(30, 1, 1, 1000);
    const osg::ref_ptr<AnimatedCharacter> first = makeTubeCharacter(armSet());
    ASSERT_TRUE(first->getMeshes().setPixelError(0.25f));
    const auto charactersOf = [&](int begin, int end)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int i = begin; i < end; ++i)
        {
            const osg::ref_ptr<AnimatedCharacter> character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
            character->setMatrix(placeAtDepth(i));
            group->addChild(character);
        }
        return group;
    };
    GLuint ofEach = 0;
    std::set<GLuint> counts;
    for (int i = 0; i < 9; ++i)
    {
        const GLuint triangles = trianglesDrawn(*charactersOf(i, i + 1));
        counts.insert(triangles);
        ofEach += triangles;
    }
    EXPECT_EQ(counts.size(), 3u) << "three levels";
    const osg::ref_ptr<osg::Group> apart = charactersOf(0, 9), together = charactersOf(0, 9);
    for (unsigned int i = 0; i < 9; ++i)
        static_cast<AnimatedCharacter*>(apart->getChild(i))->setDrawnTogether(false);
    EXPECT_EQ(trianglesDrawn(*apart), ofEach);
    const osg::ref_ptr<osg::Image> expected = picture().copy();
    EXPECT_GT(picture().pixelsDrawn(), 100);
    EXPECT_EQ(trianglesDrawn(*together), ofEach);
    EXPECT_LE(Picture::pixelsDifferent(*expected, picture().image()), 8) << "placements are floats in shared draws";
    double drawables = 0.0;
    osg::Stats& stats = *viewer().getCamera()->getStats();
    stats.collectStats("scene", true);
    drawAt(0.1);
    stats.getAttribute(viewer().getFrameStamp()->getFrameNumber(), "Visible number of drawables", drawables);
    EXPECT_EQ(drawables, 2.0 * 3.0);
}

// Instances of one level of detail share a draw: the draws of later levels start within the batch.
TEST_F(LodDrawsGLTest, tintsAreTheInstancesOwnAtEveryLevel)
{
    const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(armSet());
    ASSERT_TRUE(tube->getMeshes().setPixelError(0.25f));
    viewer().getCamera()->setProjectionMatrixAsPerspective(30, 1, 1, 1000);
    const osg::ref_ptr<AnimatedCrowd> all = new AnimatedCrowd(*tube);
    const osg::ref_ptr<osg::Group> alone = new osg::Group;
    GLuint ofEach = 0;
    for (int i = 0; i < 9; ++i)
    {
        const osg::ref_ptr<AnimatedCrowd> one = new AnimatedCrowd(*tube);
        for (AnimatedCrowd* crowd : {all.get(), one.get()})
        {
            EXPECT_TRUE(crowd->setOrigin(osg::Vec3d()));
            const osg::Vec4 tint(0.3f * static_cast<float>(i % 3), 0.3f * static_cast<float>(i / 3), 1, 1);
            ASSERT_TRUE(crowd->add(placeAtDepth(i), tube->getController(), tint));
        }
        alone->addChild(one);
        ofEach += trianglesDrawn(*one);
    }
    EXPECT_EQ(trianglesDrawn(*alone), ofEach);
    const osg::ref_ptr<osg::Image> expected = picture().copy();
    EXPECT_GT(picture().pixelsDrawn(), 100);
    EXPECT_EQ(trianglesDrawn(*all), ofEach);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, picture().image()), 0);
}

} // namespace

// Levels of detail are not visible, whatever the morphs and the shadows: pictures differ by less than two
// pictures of all triangles when the camera turns by half a pixel.

namespace
{

using MakeShadows = osgShadow::ShadowTechnique* (*)();

struct PictureCase
{
    const char* name;
    bool isMorphed;
    MakeShadows makeShadows = nullptr;
};

void PrintTo(const PictureCase& picture, std::ostream* out)
{
    *out << picture.name;
}

osg::ref_ptr<osg::LightSource> makeLight()
{
    osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    light->getLight()->setPosition(osg::Vec4(-0.4f, 0.3f, 1.0f, 0.0f));
    light->getLight()->setDirection(osg::Vec3(0.4f, -0.3f, -1.0f)); // ParallelSplitShadowMap uses the direction
    return light;
}

template <typename Technique>
osgShadow::ShadowTechnique* make()
{
    return new Technique;
}

class LodSceneGLTest : public ViewerGLTest
{
protected:
    static constexpr int side = 256; ///< pixels
    static constexpr int across = 3; ///< tubes per row and per column
    const osg::Vec3d centre{14, 14, 0};

    int pictureSide() const override { return side; }

    /// Tubes at different times above a floor.
    osg::ref_ptr<osg::Group> makeScene(const PictureCase& look, bool isCrowd, float pixelError)
    {
        const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(armSet(look.isMorphed));
        EXPECT_TRUE(tube->getMeshes().setPixelError(pixelError));
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*tube);
        const osg::ref_ptr<osg::Group> scene = look.makeShadows ? makeShadowed(look.makeShadows) : new osg::Group;
        if (!look.makeShadows) scene->addChild(makeLight());
        if (isCrowd) scene->addChild(crowd);
        for (int i = 0; i < across * across; ++i)
        {
            const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(tube.get(), osg::CopyOp::DEEP_COPY_NODES);
            copy->getController().seek(0.1 * i);
            copy->setMatrix(osg::Matrix::translate(10.0 * (i % across), 10.0 * (i / across), 0.0));
            if (isCrowd)
                EXPECT_TRUE(crowd->add(copy->getMatrix(), copy->getController()));
            else
                scene->addChild(copy);
        }
        osg::ref_ptr<osg::Geode> floor = new osg::Geode;
        floor->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3(14, 14, -2), 34, 34, 0.2f)));
        scene->addChild(floor);
        waitForLevels(*scene);
        return scene;
    }

    osg::Group* makeShadowed(MakeShadows makeShadows)
    {
        _techniques.push_back(makeShadows());
        auto* scene = new osgShadow::ShadowedScene(_techniques.back());
        scene->addChild(makeLight());
        scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        scene->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
        return scene;
    }

    /// Places the camera so that a tube is that many pixels long. shift: of the picture, in pixels.
    static void look(osg::Camera& camera, const osg::Vec3d& at, double pixels, double shift)
    {
        const double half = osg::DegreesToRadians(15.0);
        const double distance = 8.0 * side / (2.0 * std::tan(half) * pixels);
        camera.setProjectionMatrixAsPerspective(30.0, 1.0, 0.2 * distance, 40.0 + 2.0 * distance);
        camera.setProjectionMatrix(camera.getProjectionMatrix() * osg::Matrix::translate(2.0 * shift / side, 0.0, 0.0));
        camera.setViewMatrixAsLookAt(at + osg::Vec3d(0.2, -0.5, 0.8) * distance, at, {0, 0, 1});
    }

    osg::ref_ptr<osg::Image> drawn(osg::Node& scene)
    {
        viewer().setLightingMode(osg::View::NO_LIGHT);
        _count->attach(*viewer().getCamera(), picture());
        return pictureOf(&scene, {0.0, 0.1, 0.2, 0.3});
    }

    GLuint primitives() const { return _count->primitives(); } ///< of the last frame

private:
    osg::ref_ptr<PrimitiveCount> _count = new PrimitiveCount;
    // With OSG 3.6.5 the end of a viewer never returns if its StandardShadowMap was deleted before (osg::Identifier).
    std::vector<osg::ref_ptr<osgShadow::ShadowTechnique>> _techniques;
};

class LodPicturesGLTest : public LodSceneGLTest, public ::testing::WithParamInterface<PictureCase>
{
protected:
    osg::ref_ptr<osg::Group> makeScene(bool isCrowd, float pixelError)
    {
        return LodSceneGLTest::makeScene(GetParam(), isCrowd, pixelError);
    }

    osg::ref_ptr<osg::Image> pictureAt(osg::Group& scene, double pixels, double shift = 0.0)
    {
        look(*viewer().getCamera(), centre, pixels, shift);
        return drawn(scene);
    }
};

TEST_P(LodPicturesGLTest, lookAsWithAllTriangles)
{
    constexpr float visible = 0.1f; ///< the smallest visible difference of a colour
    for (const bool isCrowd : {false, true})
        for (const double pixels : {60.0, 25.0})
        {
            const osg::ref_ptr<osg::Group> all = makeScene(isCrowd, 0.0f), fewer = makeScene(isCrowd, 0.5f);
            const osg::ref_ptr<osg::Image> expected = pictureAt(*all, pixels);
            const GLuint ofAll = primitives();
            const osg::ref_ptr<osg::Image> found = pictureAt(*fewer, pixels);
            EXPECT_LT(4 * primitives(), ofAll);
            const osg::ref_ptr<osg::Image> moved = pictureAt(*all, pixels, 0.5);
            EXPECT_LT(2.0 * Picture::meanDifference(*expected, *found), Picture::meanDifference(*expected, *moved));
            EXPECT_LT(2 * Picture::pixelsDifferent(*expected, *found, visible),
                      Picture::pixelsDifferent(*expected, *moved, visible));
        }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, LodPicturesGLTest,
    ::testing::Values(PictureCase{"Plain", false}, PictureCase{"Morphed", true},
                      PictureCase{"ShadowMap", true, make<osgShadow::ShadowMap>},
                      PictureCase{"ViewDependentShadowMap", true, make<osgShadow::ViewDependentShadowMap>},
                      PictureCase{"StandardShadowMap", true, make<osgShadow::StandardShadowMap>},
                      PictureCase{"LightSpacePerspectiveShadowMap", true,
                                  make<osgShadow::LightSpacePerspectiveShadowMapVB>},
                      PictureCase{"ParallelSplitShadowMap", true, make<osgShadow::ParallelSplitShadowMap>},
                      PictureCase{"SoftShadowMap", true, make<osgShadow::SoftShadowMap>}),
    [](const auto& info) { return std::string(info.param.name); });

// Primitives of shadow maps are counted for a camera below the viewer's own.
class LodShadowsGLTest : public LodSceneGLTest
{
protected:
    using Look = void (*)(osg::Camera& camera, const osg::Vec3d& centre);
    static constexpr PictureCase plain{"Plain", false};
    static constexpr PictureCase shadows{"ShadowMap", false, make<osgShadow::ShadowMap>};

    static void fromFarOff(osg::Camera& camera, const osg::Vec3d& at) { look(camera, at, 25.0, 0.0); }

    /// The primitives of a camera that looks at the scene's centre in that way. The viewer's own camera is near by and
    /// must not select the levels.
    GLuint primitivesOf(osg::Group& shown, Look look)
    {
        const osg::ref_ptr<osg::MatrixTransform> moved = new osg::MatrixTransform;
        moved->setMatrix(osg::Matrix::rotate(1.0, 0, 0, 1) * osg::Matrix::translate(300, -200, 100));
        moved->addChild(&shown);
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        camera->setRenderOrder(osg::Camera::POST_RENDER);
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera->setViewport(0, 0, viewportSide, viewportSide);
        camera->addChild(moved);
        look(*camera, centre * moved->getMatrix());
        LodSceneGLTest::look(*viewer().getCamera(), centre * moved->getMatrix(), 2500.0, 0.0);
        viewer().getCamera()->setProjectionMatrixAsOrtho(-1, 1, -1, 1, 1, 1000);
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(makeLight()); // osgShadow searches for lights in the view of the viewer's own camera
        scene->addChild(camera);
        drawn(*scene);
        return primitives();
    }

    int viewportSide = side; ///< of that camera
};

// Shadow passes use the main camera's level, so that no surface shadows itself.
TEST_F(LodShadowsGLTest, shadowMapsHaveTheLevelsOfTheCameraThatTheyAreFor)
{
    for (const bool isCrowd : {false, true})
    {
        const auto primitivesOf = [&](const PictureCase& what, float pixelError)
        { return LodShadowsGLTest::primitivesOf(*makeScene(what, isCrowd, pixelError), fromFarOff); };
        const GLuint ofAll = primitivesOf(plain, 0.0f), ofFewer = primitivesOf(plain, 0.5f);
        EXPECT_LT(4 * ofFewer, ofAll);
        EXPECT_EQ(primitivesOf(shadows, 0.0f), 2 * ofAll);
        EXPECT_EQ(primitivesOf(shadows, 0.5f), 2 * ofFewer);
        viewportSide = side / 4; // a tube is a quarter as many pixels long
        const GLuint inSmall = primitivesOf(plain, 0.5f);
        EXPECT_LT(inSmall, ofFewer);
        EXPECT_EQ(primitivesOf(shadows, 0.5f), 2 * inSmall);
        viewportSide = side;
    }
}

// A near camera that draws only depth is treated as the camera of a shadow map.
TEST_F(LodShadowsGLTest, camerasWithAColourBufferHaveLevelsOfTheirOwn)
{
    const GLuint ofFewer = primitivesOf(*makeScene(plain, false, 0.5f), fromFarOff);
    for (const bool hasColour : {false, true})
    {
        const osg::ref_ptr<osg::Group> scene = makeScene(plain, false, 0.5f);
        const osg::ref_ptr<osg::Camera> depths = new osg::Camera;
        depths->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        depths->setRenderOrder(osg::Camera::PRE_RENDER);
        depths->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
        depths->attach(osg::Camera::DEPTH_BUFFER, GL_DEPTH_COMPONENT24);
        if (hasColour) depths->attach(osg::Camera::COLOR_BUFFER, GL_RGBA);
        depths->setViewport(0, 0, side, side);
        depths->setCullingMode(osg::CullSettings::NO_CULLING);
        depths->setProjectionMatrixAsOrtho(-1, 1, -1, 1, 1, 1000);
        depths->addChild(scene);
        const osg::ref_ptr<osg::Group> both = new osg::Group;
        both->addChild(scene);
        both->addChild(depths);
        const GLuint ofBoth = primitivesOf(*both, fromFarOff);
        if (hasColour)
            EXPECT_GT(ofBoth, 8 * ofFewer);
        else
            EXPECT_EQ(ofBoth, 2 * ofFewer);
    }
}

} // namespace

} // namespace osgGpuAnimation
