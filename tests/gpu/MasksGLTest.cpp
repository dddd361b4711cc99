// SPDX-License-Identifier: MIT
#include "support/GaitSet.h"
#include "support/GLTest.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

class MasksGLTest : public GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _pipeline = PosePipeline::of(state());
        ASSERT_NE(_pipeline, nullptr);
        ASSERT_TRUE(controller.play("Walk"));
        ASSERT_TRUE(controller.layer(1).play("Turn"));
        controller.layer(1).seek(0.4);
    }

    void setSpine(float weight)
    {
        JointMask mask(*set);
        mask.setJoint(static_cast<std::size_t>(set->skeleton().findJoint("spine1")), weight);
        ASSERT_TRUE(controller.layer(1).setMask(mask));
    }

    std::unique_ptr<PoseBatch> batchNow() const
    {
        auto batch = std::make_unique<PoseBatch>(set);
        batch->add(controller.instruction());
        return batch;
    }

    std::vector<AffineMatrix> twinNow() const
    {
        std::vector<AffineMatrix> twin;
        Pose::evaluate(*set, controller.instruction(), AffineMatrix(), twin);
        return twin;
    }

    void expectPose(const PoseBatch& batch, const std::vector<AffineMatrix>& twin)
    {
        ASSERT_TRUE(_pipeline->evaluate(state(), batch, 0));
        const std::vector<AffineMatrix> palette = _pipeline->readPalette(state(), *set, 0, 0);
        ASSERT_EQ(palette.size(), twin.size());
        for (std::size_t entry = 0; entry < twin.size(); ++entry)
            for (std::size_t row = 0; row < 3; ++row)
                for (int column = 0; column < 4; ++column)
                    ASSERT_NEAR(palette[entry].rows[row][column], twin[entry].rows[row][column], 1e-5f) << entry;
    }

    const std::shared_ptr<const AnimationSet> set = makeGaitSet();
    AnimationController controller{set};

private:
    PosePipeline* _pipeline = nullptr;
};

TEST_F(MasksGLTest, aHundredThousandChangesShowTheRightPose)
{
    std::unique_ptr<PoseBatch> batch;
    for (int change = 0; change < 100000; ++change)
    {
        setSpine(static_cast<float>(change % 997) / 997.0f);
        if (HasFatalFailure()) return;
        if (change % 500 > 3) continue; // four changes in a row: numbers of freed masks are used again
        batch = batchNow();
        expectPose(*batch, twinNow());
        if (HasFatalFailure()) FAIL() << "change " << change;
    }
    EXPECT_LE(set->masks().count(), 3u);
}

// The samples of two frames are equal bit by bit, but the mask of that number is another.
TEST_F(MasksGLTest, aNumberThatIsUsedAgainIsANewPose)
{
    setSpine(1.0f);
    const std::uint32_t number = controller.layer(1).mask();
    expectPose(*batchNow(), twinNow());
    setSpine(0.5f);
    setSpine(0.1f);
    ASSERT_EQ(controller.layer(1).mask(), number);
    expectPose(*batchNow(), twinNow());
}

// The draw side evaluates a frame later, when the controllers have gone on.
TEST_F(MasksGLTest, framesThatAreStillDrawnKeepTheirMasks)
{
    std::vector<std::unique_ptr<PoseBatch>> frames;
    std::vector<std::vector<AffineMatrix>> twins;
    for (int frame = 0; frame < 5; ++frame)
    {
        setSpine(0.2f * static_cast<float>(frame));
        frames.push_back(batchNow());
        twins.push_back(twinNow());
    }
    controller.layer(1).clearMask();
    EXPECT_EQ(set->masks().count(), 5u);
    for (std::size_t frame = 5; frame-- > 0;)
        expectPose(*frames[frame], twins[frame]);
    frames.clear();
    EXPECT_EQ(set->masks().count(), 0u);
}

TEST_F(MasksGLTest, anInstructionWhoseMaskIsGoneHasNoMask)
{
    setSpine(0.3f);
    const PoseInstruction old = controller.instruction();
    controller.layer(1).clearMask();
    std::vector<AffineMatrix> twin;
    Pose::evaluate(*set, old, AffineMatrix(), twin);
    PoseBatch batch(set);
    batch.add(old);
    expectPose(batch, twin);
    expectPose(batch, twinNow());
}

// A batch without a set has an empty one and no palette.
TEST_F(MasksGLTest, aBatchWithoutASetIsRefused)
{
    PoseBatch batch(nullptr);
    EXPECT_EQ(batch.set().paletteSize(), 0u);
    EXPECT_EQ(batch.add(PoseInstruction()), 0u);
    EXPECT_TRUE(batch.isSame(batch));
    EXPECT_FALSE(PosePipeline::of(state())->evaluate(state(), batch, 0));
    EXPECT_TRUE(PosePipeline::of(state())->evaluate(state(), *batchNow(), 0));
}

} // namespace

} // namespace osgGpuAnimation
