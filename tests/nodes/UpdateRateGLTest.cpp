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
    /// Groups' palettes are without root matrices.
    unsigned int lateness(AnimatedCrowd::Instance instance, std::size_t slot, std::size_t place, bool isOfGroup = true)
    {
        const CrowdInstances& all = crowd->instances();
        const std::size_t index = all.indexOf(instance);
        const auto shown = PosePipeline::of(state())->readPalette(state(), crowd->set(), slot, place);
        const AffineMatrix root = isOfGroup ? AffineMatrix() : all.rootMatrix(index);
        AnimationController controller = all.controllerCopy(index);
        for (unsigned int late = 0; late < every; ++late, controller.advance(-step))
        {
            std::vector<AffineMatrix> twin;
            controller.advance(0.0);
            Pose::evaluate(crowd->set(), controller.instruction(), root, twin);
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
            EXPECT_EQ(lateness(instances[i], 0, i, false), 0u);
    }
}

TEST_F(UpdateRateGLTest, whatMovesOrGoesIsShownAtOnceAndIsNotEvaluated)
{
    const auto scene = [&](AnimatedCrowd* shown) { viewer().setSceneData(shown); };
    const double time = step * (frames = 2 * every);
    const auto plain = [&]
    {
        osg::ref_ptr<AnimatedCrowd> copy = osg::clone(crowd.get());
        EXPECT_TRUE(copy->setUpdateRate(UpdateRate()));
        scene(copy);
        drawAt(time);
        return picture().copy();
    };
    ASSERT_TRUE(crowd->setUpdateRate({every, 1e6f}));
    for (unsigned int frame = 0; frame <= every; ++frame)
        drawAt(time); // so that all groups have had their turn at that time
    for (int round = 0; round < 3; ++round)
    {
        for (std::size_t i = static_cast<std::size_t>(round); i < instances.size(); ++i)
        {
            const osg::Vec3d place(i % 2 ? 0.75 - round : -3.0 + round, 0.0,
                                   -3.25 + 1.125 * static_cast<double>(i / 2));
            ASSERT_TRUE(
                crowd->move(instances[i], osg::Matrixd::rotate(0.1 * round, 0, 1, 0) * osg::Matrixd::translate(place)));
        }
        ASSERT_TRUE(crowd->remove(instances[static_cast<std::size_t>(round)]));
        ASSERT_TRUE(crowd->setTint(instances[7 + static_cast<std::size_t>(round)], osg::Vec4(1, 0, 0, 1)));
        viewer().getCamera()->setViewMatrixAsLookAt({0.5 * round, -10, 0}, {0.5 * round, 0, 0}, {0, 0, 1});
        const osg::ref_ptr<osg::Image> expected = plain();
        scene(crowd);
        const std::uint64_t before = PosePipeline::of(state())->counters().instancesEvaluated;
        drawAt(time);
        // A colour is part of what the pipeline has of a group, a place is not; the other crowd took the palettes'
        // slot.
        EXPECT_LE(PosePipeline::of(state())->counters().instancesEvaluated - before, 12u);
        EXPECT_GT(picture().pixelsDrawn(), 5 * 64);
        EXPECT_LE(Picture::pixelsDifferent(*expected, picture().image()), 16) << round;
    }
    for (std::size_t i = 3; i < instances.size(); ++i)
        ASSERT_TRUE(crowd->setTint(instances[i], osg::Vec4(1, 1, 1, 1)));
    const osg::ref_ptr<osg::Image> white = plain();
    scene(crowd);
    drawAt(time);
    EXPECT_LE(Picture::pixelsDifferent(*white, picture().image()), 16);
    const std::uint64_t before = PosePipeline::of(state())->counters().instancesEvaluated;
    ASSERT_TRUE(crowd->move(instances[5], osg::Matrixd::translate(1.0, 0.0, 1.0)));
    ASSERT_TRUE(crowd->remove(instances[6]));
    drawAt(time);
    // No more than the group whose turn it is, without the one that went.
    EXPECT_LT(PosePipeline::of(state())->counters().instancesEvaluated - before, everybody / every);
}

TEST_F(UpdateRateGLTest, turnsComeWhileTimeStandsStill)
{
    ASSERT_TRUE(crowd->setUpdateRate({every, 1e6f}));
    for (unsigned int frame = 0; frame < 2 * every; ++frame)
        drawAt(step);
    for (std::size_t i = 0; i < instances.size(); ++i)
        crowd->controller(instances[i])->seek(1.25 + 0.01 * static_cast<double>(i)); // equal groups would share a slot
    for (unsigned int frame = 0; frame <= every; ++frame)
        drawAt(step);
    for (std::size_t i = 0; i < instances.size(); ++i)
        EXPECT_LT(lateness(instances[i], i % every, i / every), every) << "instance " << i;
}

TEST_F(UpdateRateGLTest, whatComesIsUpToDateUntilItsTurn)
{
    ASSERT_TRUE(crowd->setUpdateRate({every, 1e6f}));
    for (unsigned int frame = 0; frame < 2 * every; ++frame)
        drawNext();
    AnimationController controller(testCharacterSet());
    ASSERT_TRUE(controller.play("shift"));
    for (unsigned int frame = 0; frame < every; ++frame)
        ASSERT_TRUE(crowd->add(osg::Matrixd::translate(0.0, 0.0, -1.0), controller));
    for (unsigned int frame = 0; frame < every; ++frame)
    {
        // A group's turn takes in the one that is new in it; the others that are new are evaluated besides.
        EXPECT_EQ(evaluatedInNext(), everybody / every + every - frame);
    }
    EXPECT_EQ(evaluatedInNext(), everybody / every + 1);
}

TEST_F(UpdateRateGLTest, eachCameraHasItsOwn)
{
    viewer();
    osg::ref_ptr<osg::Camera> near = new osg::Camera;
    near->setGraphicsContext(&context());
    near->setViewport(0, 0, 64, 64);
    near->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    viewer().addSlave(near, osg::Matrixd::scale(0.5, 0.5, 1.0), osg::Matrixd());
    // Their diameter in one is twice the other's; 8 pixels are a unit in the first.
    float radius = 0.0f;
    for (std::size_t i = 0; i < instances.size(); ++i)
        radius = std::max(radius, crowd->instances().sphere(i).w);
    ASSERT_TRUE(crowd->setUpdateRate({every, 1.5f * radius * 8.0f}));
    for (unsigned int frame = 0; frame < 2 * every; ++frame)
        drawNext();
    EXPECT_EQ(evaluatedInNext(), everybody + everybody / every);
    for (std::size_t i = 0; i < instances.size(); ++i)
        EXPECT_EQ(lateness(instances[i], 0, i, false), 0u); // the first camera's, in which they are large
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
