// SPDX-License-Identifier: MIT
#include "nodes/GlCallTrace.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/PoseStatistics.h>

#include <osg/Group>
#include <osgViewer/ViewerEventHandlers>

namespace osgGpuAnimation
{

namespace
{

/// Shows what StatsHandler keeps to itself.
class OpenStatsHandler : public osgViewer::StatsHandler
{
public:
    std::size_t lineCount() const { return _userStatsLines.size(); }
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

    /// Of the frame drawn last; -1: none is recorded.
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
    EXPECT_EQ(recorded(PoseStatistics::jointsSeen), 3.0 * testCharacterSet()->skeleton().jointCount());
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

TEST_F(PoseStatisticsGLTest, aKeyAddsTheLinesOnceWhileNothingIsShown)
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
}

TEST_F(PoseStatisticsGLTest, anApplicationWithoutKeysAddsTheHandler)
{
    osg::ref_ptr<OpenStatsHandler> handler = new OpenStatsHandler;
    viewer().addEventHandler(new PoseStatistics);
    viewer().addEventHandler(handler);
    viewer().setSceneData(makeTestCharacter());
    press('s');
    drawAt(0.0);
    EXPECT_EQ(handler->lineCount(), 4u);
}

} // namespace

} // namespace osgGpuAnimation
