// SPDX-License-Identifier: MIT
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osg/MatrixTransform>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgUtil/LineSegmentIntersector>

// Poses far out of the bind pose are neither culled nor clipped by computed near and far planes.

namespace osgGpuAnimation
{

namespace
{

struct NearFarMode
{
    const char* name;
    osg::CullSettings::ComputeNearFarMode mode;
};

const NearFarMode nearFarModes[] = {
    {"bounding volumes", osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES},
    {"primitives", osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES},
    {"near by primitives", osg::CullSettings::COMPUTE_NEAR_USING_PRIMITIVES},
};

/// The test character, or a crowd of one.
osg::ref_ptr<osg::Node> makeAnimated(bool isCrowd)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    if (isCrowd) return makeCrowd(*character);
    return character;
}

class PosedBoundsGLTest : public ViewerGLTest
{
protected:
    /// Turns the node so that "shift", which moves the square along +X, moves it by 4 units towards the camera or away
    /// from it. OSG adds a margin of one unit to the planes that it computes.
    static osg::ref_ptr<osg::MatrixTransform> turned(osg::Node* node, double degrees)
    {
        const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(
            osg::Matrix::scale(2.5, 2.5, 2.5) * osg::Matrix::rotate(osg::DegreesToRadians(degrees), 0, 0, 1));
        transform->addChild(node);
        return transform;
    }

    static osg::ref_ptr<osg::Geometry> plainTriangle()
    {
        const osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
        for (const osg::Vec3 corner : {osg::Vec3(0.2f, 0, 0.5f), osg::Vec3(0.3f, 0, 0.5f), osg::Vec3(0.2f, 0, 0.6f)})
            positions->push_back(corner);
        const osg::ref_ptr<osg::Geometry> triangle = new osg::Geometry;
        triangle->setVertexArray(positions);
        triangle->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
        return triangle;
    }

    int pixelsOf(osg::Node* scene)
    {
        pictureOf(scene, {0.0, 1.9});
        return picture().pixelsDrawn();
    }

    static bool isHitAt(osg::Node& node, double x)
    {
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
            new osgUtil::LineSegmentIntersector(osg::Vec3d(x, -5, 0.5), osg::Vec3d(x, 5, 0.5));
        osgUtil::IntersectionVisitor visitor(ray);
        node.accept(visitor);
        return ray->containsIntersections();
    }
};

} // namespace

TEST_F(PosedBoundsGLTest, nearAndFarPlanesHoldThePose)
{
    for (const double degrees : {-70.0, 70.0})
        for (const bool isCrowd : {false, true})
        {
            // OSG tests the primitives of a drawable across the frustum's border only if another one is wholly inside.
            const osg::ref_ptr<osg::Group> scene = turned(makeAnimated(isCrowd), degrees);
            scene->addChild(plainTriangle());
            viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
            // Planes that OSG computed before are now the camera's own; this resets them.
            viewer().getCamera()->setProjectionMatrixAsOrtho(0.1, 8.1, -4, 4, 1, 20);
            const int wanted = pixelsOf(scene);
            EXPECT_GE(wanted, 16);
            for (const NearFarMode& mode : nearFarModes)
            {
                SCOPED_TRACE(testing::Message() << mode.name << (isCrowd ? ", crowd, " : ", ") << degrees);
                viewer().getCamera()->setComputeNearFarMode(mode.mode);
                EXPECT_EQ(pixelsOf(scene), wanted);
            }
        }
}

// The instance that reaches farthest (or nearest) is not the one with the farthest (or nearest) centre.
TEST_F(PosedBoundsGLTest, nearAndFarPlanesHoldLargeInstancesBesideSmallOnes)
{
    const auto largeOne = [](double away)
    {
        return osg::Matrixd::scale(5, 5, 5) * osg::Matrixd::rotate(away * osg::DegreesToRadians(80.0), 0, 0, 1) *
               osg::Matrixd::translate(0, 0, -2.5);
    };
    const auto smallOne = [](double depth)
    { return osg::Matrixd::scale(0.4, 0.4, 0.4) * osg::Matrixd::translate(-2, depth, 0); };
    const std::pair<const char*, std::vector<osg::Matrixd>> crowds[] = {
        {"away from the eye", {largeOne(1), smallOne(2.6), smallOne(-2)}},
        {"towards the eye", {largeOne(-1), smallOne(-2.6), smallOne(2)}},
        {"a sphere around the eye",
         {osg::Matrixd::scale(6, 6, 6) * osg::Matrixd::translate(-2, -8, -3), osg::Matrixd::translate(-4, 2, 0)}}};
    for (const auto& [name, places] : crowds)
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        addInstances(*crowd, places, still());
        viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        viewer().getCamera()->setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 20); // the last cull changed its planes
        const osg::ref_ptr<osg::Image> expected = pictureOf(crowd, {0.0});
        EXPECT_GT(picture().pixelsDrawn(), 200);
        viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(crowd, {0.0})), 0) << name;
    }
}

TEST_F(PosedBoundsGLTest, theViewMaySeeThePoseAloneAndCullsWhatIsSmall)
{
    for (const bool isCrowd : {false, true})
    {
        const osg::ref_ptr<osg::Node> scene = makeAnimated(isCrowd);
        viewer().getCamera()->setSmallFeatureCullingPixelSize(2.0f);
        viewer().getCamera()->setProjectionMatrixAsOrtho(2.5, 5.0, -1.0, 1.5, 1, 20); // the bind pose ends at x = 1
        EXPECT_GE(pixelsOf(scene), 64);
        viewer().getCamera()->setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 20);
        viewer().getCamera()->setSmallFeatureCullingPixelSize(12.0f); // the square covers 8 pixels, the clip's box 24
        EXPECT_GE(pixelsOf(scene), 36);
        viewer().getCamera()->setSmallFeatureCullingPixelSize(48.0f);
        EXPECT_EQ(pixelsOf(scene), 0);
    }
}

TEST_F(PosedBoundsGLTest, jointsThatTheApplicationPosesAreDrawnPickedAndBoundedWhereTheyAre)
{
    constexpr std::size_t tip = 1; // the joint of the square
    for (const bool isCrowd : {false, true})
    {
        SCOPED_TRACE(isCrowd ? "crowd" : "character");
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        const auto instance = crowd->add(osg::Matrix(), character->getController()).value();
        osg::ref_ptr<osg::Node> scene = character;
        if (isCrowd) scene = crowd;
        const auto pose = [&]() -> JointPose&
        { return (isCrowd ? *crowd->getController(instance) : character->getController()).layer(1).pose(); };
        // The view begins where no clip leads; the square ends at x = 3 in "shift".
        viewer().getCamera()->setProjectionMatrixAsOrtho(30, 38, -4, 4, 1, 20);
        pictureOf(scene, {0.0, 0.1});
        EXPECT_EQ(picture().pixelsDrawn(), 0);
        EXPECT_FALSE(isHitAt(*scene, 34.5));
        ASSERT_TRUE(pose().setTranslation(tip, {34, 0, 0}));
        drawAt(0.1);
        EXPECT_GE(picture().pixelsDrawn(), 36);
        EXPECT_TRUE(isHitAt(*scene, 34.5));
        EXPECT_GE(scene->getBound().center().x() + scene->getBound().radius(), 35.0f);
        ASSERT_TRUE(pose().setTranslation(tip, {36, 0, 0})); // between two updates: the next frame shows it
        drawAt(0.1);
        EXPECT_TRUE(isHitAt(*scene, 36.5));
        EXPECT_FALSE(isHitAt(*scene, 34.5));
        pose().reset();
        drawAt(0.1);
        EXPECT_EQ(picture().pixelsDrawn(), 0);
    }
}

} // namespace osgGpuAnimation
