// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <cmath>
#include <map>

// Characters and crowds whose joints the application poses, in a viewer.

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t tip = 1; ///< the joint of the test character's square

class PosedCharactersGLTest : public ViewerGLTest
{
protected:
    PosePipeline& pipeline() { return *PosePipeline::of(state()); }

    double differenceFromTwin(const AnimationController& controller, const AffineMatrix& root, std::size_t slot,
                              std::size_t instance)
    {
        std::vector<AffineMatrix> twin;
        Pose::evaluate(controller.set(), controller.instruction(), root, twin);
        const auto shown = pipeline().readPalette(state(), controller.set(), slot, instance);
        double largest = shown.size() == twin.size() ? 0.0 : 1e30;
        for (std::size_t e = 0; e < shown.size() && largest < 1e30; ++e)
            for (std::size_t row = 0; row < 3; ++row)
                largest = std::max(largest, static_cast<double>(glm::distance(shown[e].rows[row], twin[e].rows[row])));
        return largest;
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

TEST_F(PosedCharactersGLTest, aPosedCharacterIsDrawnPickedAndBoundedWhereItIs)
{
    for (const bool isCrowd : {false, true})
    {
        SCOPED_TRACE(isCrowd ? "crowd" : "character");
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        const auto instance = crowd->add(osg::Matrix(), character->getController()).value();
        osg::ref_ptr<osg::Node> scene = character;
        if (isCrowd) scene = crowd;
        const auto controller = [&]() -> AnimationController&
        { return isCrowd ? *crowd->getController(instance) : character->getController(); };
        // The view begins where no clip leads; the square ends at x = 3 in "shift".
        viewer().getCamera()->setProjectionMatrixAsOrtho(30, 38, -4, 4, 1, 20);
        pictureOf(scene, {0.0, 0.1});
        EXPECT_EQ(picture().pixelsDrawn(), 0);
        EXPECT_FALSE(isHitAt(*scene, 34.5));

        ASSERT_TRUE(controller().layer(1).pose().setTranslation(tip, {34, 0, 0}));
        drawAt(0.1);
        drawAt(0.1);
        EXPECT_GE(picture().pixelsDrawn(), 36);
        EXPECT_TRUE(isHitAt(*scene, 34.5));
        EXPECT_LE(differenceFromTwin(controller(), AffineMatrix(), 0, 0), 1e-5);
        EXPECT_GE(scene->getBound().center().x() + scene->getBound().radius(), 35.0f);
        if (!isCrowd)
        {
            EXPECT_NEAR(character->jointToModel(tip).value().getTrans().x(), 34.1, 1e-4);
        }

        // Written between two updates: the next frame shows it.
        ASSERT_TRUE(controller().layer(1).pose().setTranslation(tip, {36, 0, 0}));
        drawAt(0.1);
        EXPECT_TRUE(isHitAt(*scene, 36.5));
        EXPECT_FALSE(isHitAt(*scene, 34.5));
        EXPECT_LE(differenceFromTwin(controller(), AffineMatrix(), 0, 0), 1e-5);
        controller().layer(1).pose().reset();
        drawAt(0.1);
        EXPECT_EQ(picture().pixelsDrawn(), 0);
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    }
}

TEST_F(PosedCharactersGLTest, ofACrowdThoseWithoutAPoseStayInTheirBatch)
{
    constexpr std::size_t everybody = 300, every = 30;
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    std::vector<AnimatedCrowd::Instance> instances;
    for (std::size_t number = 0; number < everybody; ++number)
    {
        AnimationController controller(testCharacterSet());
        ASSERT_TRUE(controller.play("shift"));
        instances.push_back(crowd->add(osg::Matrixd::translate(-3.0 + 0.01 * number, 0, 0), controller).value());
    }
    viewer().setSceneData(crowd);
    drawAt(0.0);
    const auto counted = [&](double time)
    {
        const PosePipeline::Counters before = pipeline().getCounters();
        drawAt(time);
        PosePipeline::Counters after = pipeline().getCounters();
        after.feedbackDraws -= before.feedbackDraws;
        after.bytesUploaded -= before.bytesUploaded;
        return after;
    };
    const std::size_t drawsBefore = counted(0.1).feedbackDraws;
    for (std::size_t number = 0; number < everybody; number += every)
        crowd->getController(instances[number])->layer(1).pose().setRotation(tip, glm::quat(0.8f, 0.0f, 0.6f, 0.0f));
    EXPECT_EQ(counted(0.2).feedbackDraws, 2 * drawsBefore) << "one batch more";
    std::map<std::size_t, std::size_t> found;
    for (std::size_t number = 0; number < everybody; ++number)
    {
        const std::size_t slot = number % every == 0 ? 1 : 0,
                          index = CrowdDetail::instances(*crowd).indexOf(instances[number]);
        EXPECT_LE(differenceFromTwin(CrowdDetail::instances(*crowd).controllerCopy(index),
                                     CrowdDetail::instances(*crowd).rootMatrix(index), slot, found[slot]++),
                  1e-5);
    }
    EXPECT_EQ(found[1], everybody / every);
    // In the next frame only samples and one pose are uploaded.
    crowd->getController(instances[every])->layer(1).pose().setRotation(tip, glm::quat(0.6f, 0.0f, 0.8f, 0.0f));
    const std::size_t keyframe = testCharacterSet()->trackCount() * sizeof(JointTransform);
    EXPECT_EQ(counted(0.3).bytesUploaded, keyframe + 16 * (everybody + everybody / every));
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

} // namespace

} // namespace osgGpuAnimation
