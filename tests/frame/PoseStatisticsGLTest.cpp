// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <glm/geometric.hpp>
#include <osg/Group>
#include <osgUtil/Statistics>
#include <osgViewer/ViewerEventHandlers>

#include <algorithm>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// Gives access to StatsHandler's protected members.
class OpenStatsHandler : public osgViewer::StatsHandler
{
public:
    std::size_t lineCount() const { return _userStatsLines.size(); }
    /// From the attribute to the displayed number; 0: no such line.
    float multiplierOf(const std::string& attribute) const
    {
        for (const UserStatsLine& line : _userStatsLines)
            if (line.timeTakenName == attribute) return line.multiplier;
        return 0.0f;
    }
};

class PoseStatisticsGLTest : public ViewerGLTest
{
protected:
    void showCharacters(int seen, int unseen)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int i = 0; i < seen + unseen; ++i)
        {
            osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
            if (i >= seen) character->setMatrix(osg::Matrix::translate(100, 0, 0));
            character->addEventCallback(new CharacterKeys);
            group->addChild(character);
        }
        viewer().getCamera()->setFinalDrawCallback(nullptr);
        viewer().setSceneData(group);
    }

    void collect(bool isWanted) { viewer().getCamera()->getStats()->collectStats("gpu", isWanted); }

    /// The value for the last drawn frame; -1 if none is recorded.
    double recorded(const char* attribute)
    {
        double value = -1.0;
        viewer().getViewerStats()->getAttribute(viewer().getFrameStamp()->getFrameNumber(), attribute, value);
        return value;
    }

    void press(int key)
    {
        viewer().getEventQueue()->keyPress(key);
        viewer().getEventQueue()->keyRelease(key);
    }
};

TEST_F(PoseStatisticsGLTest, nothingIsAskedOrRecordedWhileStatsAreOff)
{
    showCharacters(3, 0);
    for (const bool wereOn : {false, true})
    {
        collect(wereOn);
        drawAt(0.0);
        drawAt(0.1);
        collect(false);
        drawAt(0.2);
        const GlCallTrace trace(state());
        drawAt(0.3);
        for (const char* call : {"glQueryCounter", "glBeginQuery", "glGetQueryObjectuiv", "glGetQueryObjectui64v"})
            EXPECT_EQ(trace.count(call), 0) << call << (wereOn ? ", after they were on" : "");
        EXPECT_EQ(recorded(PoseStatistics::charactersSeen), -1.0);
    }
}

TEST_F(PoseStatisticsGLTest, countsAndTimeAreRecordedWhileStatsAreOn)
{
    showCharacters(3, 2);
    collect(true);
    drawAt(0.0);
    drawAt(0.1);
    EXPECT_EQ(recorded(PoseStatistics::charactersSeen), 3.0);
    EXPECT_EQ(recorded(PoseStatistics::charactersEvaluated), 3.0);
    EXPECT_EQ(recorded(PoseStatistics::jointsSeen), 3 * testCharacterSet()->skeleton().jointCount());
    drawAt(0.1);
    EXPECT_EQ(recorded(PoseStatistics::charactersEvaluated), 0.0) << "nothing had changed";
    EXPECT_EQ(recorded(PoseStatistics::charactersSeen), 3.0);

    if (!state().get<osg::GLExtensions>()->isARBTimerQuerySupported) GTEST_SKIP() << "no time stamps in this context";
    for (int frame = 2; frame < 10; ++frame)
    {
        drawAt(0.1 * frame);
        glFinish();
    }
    double seconds = 0.0;
    ASSERT_TRUE(viewer().getViewerStats()->getAveragedAttribute(PoseStatistics::timeTaken, seconds));
    EXPECT_GT(seconds, 0.0);
    EXPECT_LT(seconds, 1.0);
}

// Slave cameras that see others, or the same, and a crowd with batches of two blend costs.
TEST_F(PoseStatisticsGLTest, eachCharacterCountsOnceForAllCamerasAndBatches)
{
    showCharacters(3, 2);
    osg::Group& scene = *viewer().getSceneData()->asGroup();
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    for (int i = 0; i < 6; ++i)
    {
        AnimationController controller = playing("shift");
        ASSERT_TRUE(i % 2 == 0 || controller.crossfade("turn", 1e6));
        ASSERT_TRUE(crowd->add(osg::Matrixd::translate(-3.5 + 1.2 * i, 0, 0), controller));
    }
    scene.addChild(crowd);
    // The first slave shows the two others, the second what the viewer's own camera shows.
    for (const double aside : {-100.0, 0.0})
    {
        const osg::ref_ptr<osg::Camera> slave = new osg::Camera;
        slave->setGraphicsContext(&context());
        slave->setViewport(0, 0, 64, 64);
        slave->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        viewer().addSlave(slave, osg::Matrixd(), osg::Matrixd::translate(aside, 0, 0));
    }
    collect(true);
    for (const double time : {0.0, 0.1, 0.2})
    {
        drawAt(time);
        EXPECT_EQ(recorded(PoseStatistics::charactersSeen), 5.0 + 6.0) << time;
        EXPECT_EQ(recorded(PoseStatistics::jointsSeen), 11 * testCharacterSet()->skeleton().jointCount()) << time;
    }
}

TEST_F(PoseStatisticsGLTest, aCamerasStatisticsCountWhatItsDrawsShow)
{
    const osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*first);
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(crowd);
    group->addChild(makeTestCharacter());
    for (int i = 0; i < 7; ++i)
    {
        const osg::Matrixd place = osg::Matrixd::translate(i < 5 ? -3.5 + 1.2 * i : 100, 0, 0); // two are out of view
        ASSERT_TRUE(crowd->add(place, first->getController()));
        const osg::ref_ptr<AnimatedCharacter> together = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
        together->setMatrix(place);
        group->addChild(together);
    }
    osgUtil::Statistics once;
    static_cast<osg::Drawable&>(*first->getChild(0)).accept(once);
    ASSERT_GT(once._vertexCount, 0u);
    viewer().setSceneData(group);
    osg::Stats& stats = *viewer().getCamera()->getStats();
    for (const bool isCollected : {true, false, true})
    {
        stats.collectStats("scene", isCollected);
        for (const double time : {0.1, 0.2})
        {
            drawAt(time);
            double vertices = -1.0, drawables = -1.0;
            stats.getAttribute(viewer().getFrameStamp()->getFrameNumber(), "Visible vertex count", vertices);
            stats.getAttribute(viewer().getFrameStamp()->getFrameNumber(), "Visible number of drawables", drawables);
            // 5 of the crowd, 5 in a shared draw, 1 drawn alone.
            EXPECT_EQ(vertices, isCollected ? 11.0 * once._vertexCount : -1.0) << time;
            // The crowd's draw, the first character of the shared draw, its other characters, and the single one.
            EXPECT_EQ(drawables, isCollected ? 4.0 : -1.0) << time;
        }
    }
}

TEST_F(PoseStatisticsGLTest, aKeyOrTheHandlerAddsTheLinesOnceWhileNothingIsShown)
{
    osg::ref_ptr<OpenStatsHandler> handler = new OpenStatsHandler;
    viewer().addEventHandler(handler);
    showCharacters(2, 0);
    drawAt(0.0);
    EXPECT_EQ(handler->lineCount(), 0u);
    for (const int key : {'x', 's', 's', 's', 's', 's', 's'})
    {
        press(key);
        drawAt(0.1);
        EXPECT_EQ(handler->lineCount(), 4u) << static_cast<char>(key);
    }
    EXPECT_EQ(handler->multiplierOf(PoseStatistics::timeTaken), 1e6f) << "seconds to microseconds";
    EXPECT_EQ(handler->multiplierOf(PoseStatistics::jointsSeen), 1.0f);
    osg::ref_ptr<OpenStatsHandler> second = new OpenStatsHandler;
    viewer().getEventHandlers().clear();
    viewer().addEventHandler(new PoseStatistics); // by an application without keys
    viewer().addEventHandler(second);
    viewer().setSceneData(makeTestCharacter());
    press('s');
    drawAt(0.2);
    EXPECT_EQ(second->lineCount(), 4u);
}

} // namespace

// Instances that crossfade, or whose joints the application poses, cost more: they are evaluated in a batch apart.

namespace
{

/// The largest distance of a row of the palette on the GPU, at that place of the frame's batches, from the CPU twin's;
/// huge if the sizes differ.
double differenceFromTwin(osg::State& state, const AnimationController& controller, const AffineMatrix& root,
                          std::size_t slot, std::size_t instance)
{
    std::vector<AffineMatrix> twin;
    Pose::evaluate(controller.set(), controller.instruction(), root, twin);
    const auto shown = PosePipeline::of(state)->readPalette(state, controller.set(), slot, instance);
    if (shown.size() != twin.size() || twin.empty()) return 1e30;
    double largest = 0.0;
    for (std::size_t entry = 0; entry < shown.size(); ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            largest =
                std::max(largest, static_cast<double>(glm::distance(shown[entry].rows[row], twin[entry].rows[row])));
    return largest;
}

constexpr std::size_t instanceCount = 400, every = 20;

bool isDear(std::size_t number)
{
    return number % every == 0;
}

osg::Matrixd placeInRow(std::size_t number)
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
        for (std::size_t number = 0; number < instanceCount; ++number)
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
    for (std::size_t number = 0; number < instanceCount; ++number)
        ASSERT_TRUE(crowd->add(placeInRow(number), fading(number)));
    viewer().setSceneData(crowd);
    drawAt(0.0);
    drawAt(0.25);
    EXPECT_EQ(bytesUploadedAt(0.5), 16 * (instanceCount - instanceCount / every + 2 * instanceCount / every));
    expectApart(*crowd);
}

TEST_F(BlendCostsGLTest, ofACrowdThoseWithAPoseAreMixedApart)
{
    constexpr std::size_t tip = 1;
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    std::vector<AnimatedCrowd::Instance> instances;
    for (std::size_t number = 0; number < instanceCount; ++number)
        instances.push_back(crowd->add(placeInRow(number), playing("shift")).value());
    viewer().setSceneData(crowd);
    drawAt(0.0);
    drawAt(0.1);
    for (std::size_t number = 0; number < instanceCount; number += every)
        crowd->getController(instances[number])->layer(1).pose().setRotation(tip, glm::quat(0.8f, 0.0f, 0.6f, 0.0f));
    const PosePipeline::Counters before = counters();
    drawAt(0.2);
    EXPECT_EQ(counters().feedbackDraws - before.feedbackDraws, 2 * testCharacterSet()->levelCount());
    expectApart(*crowd);
    // In the next frame only samples and one pose are uploaded.
    crowd->getController(instances[every])->layer(1).pose().setRotation(tip, glm::quat(0.6f, 0.0f, 0.8f, 0.0f));
    const std::size_t keyframe = testCharacterSet()->trackCount() * sizeof(JointTransform);
    EXPECT_EQ(bytesUploadedAt(0.3), keyframe + 16 * (instanceCount + instanceCount / every));
}

TEST_F(BlendCostsGLTest, ofSeparateCharactersThoseWhoFadeAreMixedApart)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<AnimatedCharacter*> characters;
    for (std::size_t number = 0; number < instanceCount; ++number)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        character->getController() = fading(number);
        character->setMatrix(placeInRow(number));
        root->addChild(character);
        characters.push_back(character);
    }
    pictureOf(root, {0.0, 0.25, 0.5});
    // The first minBatchSize characters share one batch at any blend cost; later ones join the batch of their cost.
    std::size_t found[2] = {};
    for (std::size_t number = 0; number < instanceCount; ++number)
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
        ASSERT_TRUE(crowd->add(placeInRow(number), fading(number)));
    viewer().setSceneData(crowd);
    drawAt(0.0);
    const PosePipeline::Counters before = counters();
    drawAt(0.25);
    EXPECT_EQ(counters().feedbackDraws - before.feedbackDraws, testCharacterSet()->levelCount());
    EXPECT_EQ(counters().instancesEvaluated - before.instancesEvaluated, PoseBatch::minBatchSize);
}

} // namespace

} // namespace osgGpuAnimation
