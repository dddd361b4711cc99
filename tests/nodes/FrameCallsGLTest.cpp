// SPDX-License-Identifier: MIT
#include "nodes/GlCallTrace.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osg/Geometry>
#include <osg/Group>

namespace osgGpuAnimation
{

namespace
{

/// The GL calls of one ordinary frame, counted by a trace.
class FrameCallsGLTest : public ViewerGLTest
{
protected:
    std::map<std::string, int> callsOfAFrame(osg::Node* scene)
    {
        viewer().getCamera()->setFinalDrawCallback(nullptr);
        viewer().setSceneData(scene);
        drawAt(0.0);
        drawAt(0.1);
        const GlCallTrace trace(state());
        drawAt(0.2);
        return trace.calls();
    }

    static osg::ref_ptr<osg::Group> characters(int count)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int i = 0; i < count; ++i)
            group->addChild(makeTestCharacter());
        return group;
    }
};

TEST_F(FrameCallsGLTest, nothingIsAskedOfTheGpuAndNothingReadBack)
{
    std::map<std::string, int> calls = callsOfAFrame(characters(10));
    const char* const allowed[] = {"glDrawArrays", "glDrawArraysInstanced", "glBeginTransformFeedback", "glBufferData",
                                   "glBufferSubData"};
    for (const char* name : allowed)
        calls.erase(name);
    for (const auto& [name, count] : calls)
        ADD_FAILURE() << name << " is called " << count << " times in a frame";
}

TEST_F(FrameCallsGLTest, feedbackAndUploadsDoNotGrowWithTheCharacters)
{
    std::map<std::string, int> one = callsOfAFrame(characters(1));
    EXPECT_EQ(one["glBeginTransformFeedback"], static_cast<int>(testCharacterSet()->levelCount()));
    for (const int count : {10, 100})
    {
        std::map<std::string, int> many = callsOfAFrame(characters(count));
        EXPECT_EQ(many["glBeginTransformFeedback"], one["glBeginTransformFeedback"]) << count;
        EXPECT_EQ(many["glBufferData"], one["glBufferData"]) << count;
        EXPECT_EQ(many["glBufferSubData"], one["glBufferSubData"]) << count;
    }
}

TEST_F(FrameCallsGLTest, theTraceSeesWhatItLooksFor)
{
    viewer().setSceneData(characters(1));
    drawAt(0.0);
    const GlCallTrace trace(state());
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    glFinish();
    unsigned char pixel[4];
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    EXPECT_EQ(trace.count("glGetIntegerv"), 1);
    EXPECT_EQ(trace.count("glFinish"), 1);
    EXPECT_EQ(trace.count("glReadPixels"), 1);
}

} // namespace

} // namespace osgGpuAnimation
