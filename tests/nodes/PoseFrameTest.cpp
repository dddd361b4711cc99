// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/stage/PoseFrame.h>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

namespace
{

osg::ref_ptr<osg::FrameStamp> makeStamp(unsigned int number, double time)
{
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setFrameNumber(number);
    stamp->setReferenceTime(time);
    return stamp;
}

} // namespace

// Cameras of one viewer fill one frame; another viewer or context has its own, even with the same number.
TEST(PoseFrameTest, aFrameIsOneContextsAndOneStamps)
{
    constexpr unsigned int context = 900; // no other test's
    const osg::ref_ptr<osg::FrameStamp> stamp = makeStamp(5, 1.5), later = makeStamp(5, 1.75), next = makeStamp(6, 1.5);
    const osg::ref_ptr<PoseFrame> frame = PoseFrame::forContext(context, stamp);
    EXPECT_EQ(frame->getFrameNumber(), 5u);
    EXPECT_EQ(PoseFrame::forContext(context, stamp), frame);
    EXPECT_NE(PoseFrame::forContext(context + 1, stamp), frame);
    for (const osg::ref_ptr<osg::FrameStamp>& other : {later, next, osg::ref_ptr<osg::FrameStamp>()})
    {
        const osg::ref_ptr<PoseFrame> found = PoseFrame::forContext(context, other);
        EXPECT_NE(found, frame);
        EXPECT_EQ(found->getFrameNumber(), other ? other->getFrameNumber() : 0u);
        EXPECT_EQ(PoseFrame::forContext(context, other), found);
    }
}

} // namespace osgGpuAnimation
