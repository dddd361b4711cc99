// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int every = 4;
constexpr int everybody = 12;
constexpr double step = 1.0 / 16.0; ///< seconds from frame to frame

double largestDifference(const std::vector<AffineMatrix>& left, const std::vector<AffineMatrix>& right)
{
    if (left.size() != right.size()) return std::numeric_limits<double>::infinity();
    double largest = 0.0;
    for (std::size_t entry = 0; entry < left.size(); ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                largest = std::max(largest, std::abs(static_cast<double>(left[entry].rows[row][column]) -
                                                     static_cast<double>(right[entry].rows[row][column])));
    return largest;
}

class UpdateRateGLTest : public ViewerGLTest
{
protected:
    void SetUp() override
    {
        ViewerGLTest::SetUp();
        crowd = new AnimatedCrowd(*makeTestCharacter());
        for (int index = 0; index < everybody; ++index)
        {
            AnimationController controller(testCharacterSet());
            ASSERT_TRUE(controller.play("shift"));
            controller.seek(0.05 * index);
            const osg::Matrixd place = osg::Matrixd::translate(index % 2 ? 0.5 : -4.0, 0.0, -3.5 + 1.25 * (index / 2));
            instances.push_back(crowd->add(place, controller).value());
        }
        viewer().setSceneData(crowd);
    }

    void drawNext() { drawAt(step * ++frames); }

    std::uint64_t evaluatedInNext()
    {
        const std::uint64_t before = PosePipeline::of(state())->counters().instancesEvaluated;
        drawNext();
        return PosePipeline::of(state())->counters().instancesEvaluated - before;
    }

    /// Updates ago of which the palette at that place shows the instance's pose; `every` and more: none of the last.
    unsigned int lateness(AnimatedCrowd::Instance instance, std::size_t slot, std::size_t place)
    {
        const CrowdInstances& all = crowd->instances();
        const std::size_t index = all.indexOf(instance);
        const auto shown = PosePipeline::of(state())->readPalette(state(), crowd->set(), slot, place);
        AnimationController controller = all.controllerCopy(index);
        for (unsigned int late = 0; late < every; ++late, controller.advance(-step))
        {
            std::vector<AffineMatrix> twin;
            controller.advance(0.0);
            Pose::evaluate(crowd->set(), controller.instruction(), all.rootMatrix(index), twin);
            if (largestDifference(shown, twin) < 1e-4) return late;
        }
        return every;
    }

    osg::ref_ptr<AnimatedCrowd> crowd;
    std::vector<AnimatedCrowd::Instance> instances;
    int frames = 0;
};

TEST_F(UpdateRateGLTest, smallOnesAreEvaluatedByTurnsAndNeverLaterThanAllowed)
{
    ASSERT_TRUE(crowd->setUpdateRate({every, 1e6f}));
    for (unsigned int frame = 0; frame < 2 * every; ++frame)
        drawNext();
    for (unsigned int frame = 0; frame < 2 * every; ++frame)
    {
        EXPECT_EQ(evaluatedInNext(), everybody / every);
        std::vector<int> latenesses(every, 0);
        for (std::size_t i = 0; i < instances.size(); ++i)
        {
            const unsigned int late = lateness(instances[i], i % every, i / every);
            ASSERT_LT(late, every) << "instance " << i;
            ++latenesses[late];
        }
        EXPECT_EQ(latenesses, std::vector<int>(every, everybody / every));
    }
}

TEST_F(UpdateRateGLTest, largeOnesAndACrowdWithoutARateAreUpToDate)
{
    for (const UpdateRate rate : {UpdateRate{}, UpdateRate{every, 0.0f}})
    {
        ASSERT_TRUE(crowd->setUpdateRate(rate));
        drawNext();
        EXPECT_EQ(evaluatedInNext(), everybody);
        for (std::size_t i = 0; i < instances.size(); ++i)
            EXPECT_EQ(lateness(instances[i], 0, i), 0u);
    }
}

TEST_F(UpdateRateGLTest, thoseThatComeGoOrMoveLeaveTheOthersAsTheyAre)
{
    ASSERT_TRUE(crowd->setUpdateRate({every, 1e6f}));
    for (unsigned int frame = 0; frame < 2 * every; ++frame)
        drawNext();
    ASSERT_TRUE(crowd->remove(instances[every])); // of group 0; the last of group 3 takes its index
    ASSERT_TRUE(crowd->move(instances[2], osg::Matrixd::translate(100.0, 0.0, 0.0)));
    ASSERT_TRUE(crowd->move(instances[1], osg::Matrixd::translate(0.5, 0.0, -3.0)));
    drawNext();
    EXPECT_LT(lateness(instances[0], 0, 0), every);
    EXPECT_LT(lateness(instances[2 * every], 0, 1), every);
    EXPECT_LT(lateness(instances[1], 1, 0), every);
    EXPECT_LT(lateness(instances[every + 2], 2, 0), every); // the one before has left the view
    EXPECT_LT(lateness(instances[3], 3, 0), every);
    ASSERT_TRUE(crowd->move(instances[2], osg::Matrixd::translate(-4.0, 0.0, -2.0)));
    drawNext();
    EXPECT_LT(lateness(instances[2], 2, 0), every);
}

TEST_F(UpdateRateGLTest, ratesThatMakeNoSenseAreRefused)
{
    EXPECT_FALSE(crowd->setUpdateRate({0, 1.0f}));
    EXPECT_FALSE(crowd->setUpdateRate({UpdateRate::maxEvery + 1, 1.0f}));
    EXPECT_FALSE(crowd->setUpdateRate({2, -1.0f}));
    EXPECT_FALSE(crowd->setUpdateRate({2, std::nanf("")}));
    EXPECT_EQ(crowd->updateRate().every, 1u);
}

} // namespace

} // namespace osgGpuAnimation
