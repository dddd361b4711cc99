// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/MatrixTransform>

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

    static osg::ref_ptr<AnimatedCrowd> crowdOfOne()
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        AnimationController controller(testCharacterSet());
        EXPECT_TRUE(controller.play("shift"));
        EXPECT_TRUE(crowd->add(osg::Matrix(), controller));
        return crowd;
    }

    int pixelsOf(osg::Node* scene)
    {
        viewer().setSceneData(scene);
        drawAt(0.0);
        drawAt(1.9);
        return picture().pixelsDrawn();
    }
};

} // namespace

TEST_F(PosedBoundsGLTest, nearAndFarPlanesHoldThePose)
{
    for (const double degrees : {-70.0, 70.0})
        for (const bool isCrowd : {false, true})
        {
            osg::ref_ptr<osg::Node> node;
            if (isCrowd)
                node = crowdOfOne();
            else
                node = makeTestCharacter();
            // OSG tests the primitives of a drawable across the frustum's border only if another one is wholly inside.
            const osg::ref_ptr<osg::Group> scene = turned(node, degrees);
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

TEST_F(PosedBoundsGLTest, theViewMaySeeThePoseAlone)
{
    viewer().getCamera()->setProjectionMatrixAsOrtho(2.5, 5.0, -1.0, 1.5, 1, 20); // the bind pose ends at x = 1
    EXPECT_GE(pixelsOf(makeTestCharacter()), 64);
    EXPECT_GE(pixelsOf(crowdOfOne()), 64);
}

TEST_F(PosedBoundsGLTest, onlyWhatIsSmallIsCulledAsSmall)
{
    for (const bool isCrowd : {false, true})
    {
        osg::ref_ptr<osg::Node> scene;
        if (isCrowd)
            scene = crowdOfOne();
        else
            scene = makeTestCharacter();
        viewer().getCamera()->setSmallFeatureCullingPixelSize(12.0f); // the square covers 8 pixels, the clip's box 24
        EXPECT_GE(pixelsOf(scene), 36);
        viewer().getCamera()->setSmallFeatureCullingPixelSize(48.0f);
        EXPECT_EQ(pixelsOf(scene), 0);
    }
}

} // namespace osgGpuAnimation
