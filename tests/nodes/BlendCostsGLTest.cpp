// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osg/Group>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t everybody = 400;

bool isFading(std::size_t number)
{
    return number % 20 == 0;
}

osg::Matrixd placeOf(std::size_t number)
{
    return osg::Matrixd::translate(-4.0 + 0.01 * static_cast<double>(number), 0.0, 0.0);
}

void start(AnimationController& controller, std::size_t number)
{
    ASSERT_TRUE(controller.play("shift"));
    controller.seek(0.003 * static_cast<double>(number));
    if (isFading(number))
    {
        ASSERT_TRUE(controller.crossfade("turn", 10.0));
    }
}

double largestDifference(const std::vector<AffineMatrix>& left, const std::vector<AffineMatrix>& right)
{
    double largest = left.size() == right.size() && !left.empty() ? 0.0 : 1e30;
    for (std::size_t entry = 0; entry < left.size() && largest < 1e30; ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                largest =
                    std::max<double>(largest, std::abs(left[entry].rows[row][column] - right[entry].rows[row][column]));
    return largest;
}

/// Many instances that play one clip, and some that crossfade.
class BlendCostsGLTest : public ViewerGLTest
{
protected:
    PosePipeline& pipeline() { return *PosePipeline::of(state()); }

    void expectPose(const AnimationController& controller, const AffineMatrix& root, std::size_t slot,
                    std::size_t instance)
    {
        std::vector<AffineMatrix> twin;
        Pose::evaluate(controller.set(), controller.instruction(), root, twin);
        const auto shown = pipeline().readPalette(state(), controller.set(), slot, instance);
        EXPECT_LT(largestDifference(shown, twin), 1e-5) << "slot " << slot << ", instance " << instance;
    }

    std::uint64_t bytesUploadedAt(double time)
    {
        const std::uint64_t before = pipeline().getCounters().bytesUploaded;
        drawAt(time);
        return pipeline().getCounters().bytesUploaded - before;
    }
};

TEST_F(BlendCostsGLTest, ofACrowdThoseWhoFadeAreMixedApart)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (std::size_t number = 0; number < everybody; ++number)
    {
        AnimationController controller(testCharacterSet());
        start(controller, number);
        ASSERT_TRUE(crowd->add(placeOf(number), controller));
    }
    viewer().setSceneData(crowd);
    drawAt(0.0);
    drawAt(0.25);
    EXPECT_EQ(bytesUploadedAt(0.5), 16 * (everybody * 19 / 20 + 2 * everybody / 20));
    std::size_t found[2] = {};
    for (std::size_t number = 0; number < everybody; ++number)
    {
        const std::size_t slot = isFading(number) ? 1 : 0;
        expectPose(CrowdDetail::instances(*crowd).controllerCopy(number),
                   CrowdDetail::instances(*crowd).rootMatrix(number), slot, found[slot]++);
    }
}

TEST_F(BlendCostsGLTest, ofSeparateCharactersThoseWhoFadeAreMixedApart)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<AnimatedCharacter*> characters;
    for (std::size_t number = 0; number < everybody; ++number)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        start(character->getController(), number);
        character->setMatrix(placeOf(number));
        root->addChild(character);
        characters.push_back(character);
    }
    viewer().setSceneData(root);
    drawAt(0.0);
    drawAt(0.25);
    drawAt(0.5);
    // The first minBatchSize characters share one batch at any blend cost; later ones join the batch of their cost.
    std::size_t found[2] = {};
    for (std::size_t number = 0; number < everybody; ++number)
    {
        const std::size_t slot = found[0] < PoseBatch::minBatchSize || isFading(number) ? 0 : 1;
        expectPose(characters[number]->getController(), AffineMatrix(), slot, found[slot]++);
    }
}

TEST_F(BlendCostsGLTest, fewStayInOneBatch)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (std::size_t number = 0; number < PoseBatch::minBatchSize; ++number)
    {
        AnimationController controller(testCharacterSet());
        start(controller, number);
        ASSERT_TRUE(crowd->add(placeOf(number), controller));
    }
    viewer().setSceneData(crowd);
    drawAt(0.0);
    const PosePipeline::Counters before = pipeline().getCounters();
    drawAt(0.25);
    EXPECT_EQ(pipeline().getCounters().feedbackDraws - before.feedbackDraws, testCharacterSet()->levelCount());
    EXPECT_EQ(pipeline().getCounters().instancesEvaluated - before.instancesEvaluated, PoseBatch::minBatchSize);
}

} // namespace

} // namespace osgGpuAnimation
