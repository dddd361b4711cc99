// SPDX-License-Identifier: MIT
#include "nodes/TwinPose.h"
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osg/Group>

// Instances that crossfade, or whose joints the application poses, cost more: they are evaluated in a batch apart.

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t everybody = 400, every = 20;

bool isDear(std::size_t number)
{
    return number % every == 0;
}

osg::Matrixd placeOf(std::size_t number)
{
    return osg::Matrixd::translate(-4.0 + 0.01 * static_cast<double>(number), 0.0, 0.0);
}

AnimationController fading(std::size_t number)
{
    AnimationController controller = playing("shift", 0.003 * static_cast<double>(number));
    EXPECT_TRUE(!isDear(number) || controller.crossfade("turn", 10.0));
    return controller;
}

class BlendCostsGLTest : public ViewerGLTest
{
protected:
    PosePipeline::Counters counters() { return PosePipeline::of(state())->getCounters(); }

    std::uint64_t bytesUploadedAt(double time)
    {
        const std::uint64_t before = counters().bytesUploaded;
        drawAt(time);
        return counters().bytesUploaded - before;
    }

    /// Those of the crowd who are dear are in the second batch, in their order.
    void expectApart(const AnimatedCrowd& crowd)
    {
        std::size_t found[2] = {};
        for (std::size_t number = 0; number < everybody; ++number)
        {
            const std::size_t slot = isDear(number) ? 1 : 0;
            EXPECT_LT(differenceFromTwin(state(), CrowdDetail::instances(crowd).controllerCopy(number),
                                         CrowdDetail::instances(crowd).rootMatrix(number), slot, found[slot]++),
                      1e-5)
                << number;
        }
    }
};

TEST_F(BlendCostsGLTest, ofACrowdThoseWhoFadeAreMixedApart)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (std::size_t number = 0; number < everybody; ++number)
        ASSERT_TRUE(crowd->add(placeOf(number), fading(number)));
    viewer().setSceneData(crowd);
    drawAt(0.0);
    drawAt(0.25);
    EXPECT_EQ(bytesUploadedAt(0.5), 16 * (everybody - everybody / every + 2 * everybody / every));
    expectApart(*crowd);
}

TEST_F(BlendCostsGLTest, ofACrowdThoseWithAPoseAreMixedApart)
{
    constexpr std::size_t tip = 1;
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    std::vector<AnimatedCrowd::Instance> instances;
    for (std::size_t number = 0; number < everybody; ++number)
        instances.push_back(crowd->add(placeOf(number), playing("shift")).value());
    viewer().setSceneData(crowd);
    drawAt(0.0);
    drawAt(0.1);
    for (std::size_t number = 0; number < everybody; number += every)
        crowd->getController(instances[number])->layer(1).pose().setRotation(tip, glm::quat(0.8f, 0.0f, 0.6f, 0.0f));
    const PosePipeline::Counters before = counters();
    drawAt(0.2);
    EXPECT_EQ(counters().feedbackDraws - before.feedbackDraws, 2 * testCharacterSet()->levelCount());
    expectApart(*crowd);
    // In the next frame only samples and one pose are uploaded.
    crowd->getController(instances[every])->layer(1).pose().setRotation(tip, glm::quat(0.6f, 0.0f, 0.8f, 0.0f));
    const std::size_t keyframe = testCharacterSet()->trackCount() * sizeof(JointTransform);
    EXPECT_EQ(bytesUploadedAt(0.3), keyframe + 16 * (everybody + everybody / every));
}

TEST_F(BlendCostsGLTest, ofSeparateCharactersThoseWhoFadeAreMixedApart)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<AnimatedCharacter*> characters;
    for (std::size_t number = 0; number < everybody; ++number)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        character->getController() = fading(number);
        character->setMatrix(placeOf(number));
        root->addChild(character);
        characters.push_back(character);
    }
    pictureOf(root, {0.0, 0.25, 0.5});
    // The first minBatchSize characters share one batch at any blend cost; later ones join the batch of their cost.
    std::size_t found[2] = {};
    for (std::size_t number = 0; number < everybody; ++number)
    {
        const std::size_t slot = found[0] < PoseBatch::minBatchSize || isDear(number) ? 0 : 1;
        EXPECT_LT(differenceFromTwin(state(), characters[number]->getController(), AffineMatrix(), slot, found[slot]++),
                  1e-5)
            << number;
    }
}

TEST_F(BlendCostsGLTest, fewStayInOneBatch)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (std::size_t number = 0; number < PoseBatch::minBatchSize; ++number)
        ASSERT_TRUE(crowd->add(placeOf(number), fading(number)));
    viewer().setSceneData(crowd);
    drawAt(0.0);
    const PosePipeline::Counters before = counters();
    drawAt(0.25);
    EXPECT_EQ(counters().feedbackDraws - before.feedbackDraws, testCharacterSet()->levelCount());
    EXPECT_EQ(counters().instancesEvaluated - before.instancesEvaluated, PoseBatch::minBatchSize);
}

} // namespace

} // namespace osgGpuAnimation
