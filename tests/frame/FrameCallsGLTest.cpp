// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "support/RandomSet.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Geometry>
#include <osg/Group>
#include <osg/Texture>

#include <algorithm>

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

    /// A character of eight levels.
    static osg::ref_ptr<AnimatedCharacter> deepCharacter()
    {
        static const std::shared_ptr<const AnimationSet> set = makeRandomSet({});
        osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
        osg::ref_ptr<SkinnedGeometry> square = makeTestSquare(1);
        square->setRigidEntry(0);
        character->addChild(square);
        character->setCullingActive(false);
        EXPECT_TRUE(character->getController().play(0));
        return character;
    }

    /// Characters whose clips play, so that each frame evaluates them, and a crowd of the same set beside them.
    static osg::ref_ptr<osg::Group> movingScene(bool hasCrowd)
    {
        osg::ref_ptr<osg::Group> group = characters(9);
        for (unsigned int i = 0; i < group->getNumChildren(); ++i)
            static_cast<AnimatedCharacter*>(group->getChild(i))->getController().setSpeed(0.1 * (i + 1));
        group->addChild(deepCharacter());
        if (!hasCrowd) return group;
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
        AnimationController controller(crowd->getSharedAnimationSet());
        EXPECT_TRUE(controller.play("turn"));
        for (int i = 0; i < 9; ++i)
            EXPECT_TRUE(crowd->add(osg::Matrix::translate(0.2 * i, 0, 1), controller, {1, 0, 0, 1}));
        group->addChild(crowd);
        return group;
    }

    /// A crowd that looks at one point, or plays its clip.
    static osg::ref_ptr<AnimatedCrowd> crowdOf(int count, bool isLooking)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        const auto set = character->getAnimationSet().withConstraints({LookAt{"look", {"base"}}});
        EXPECT_TRUE(set && character->setAnimationSet(set.value()));
        osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        AnimationController controller(crowd->getSharedAnimationSet());
        EXPECT_TRUE(controller.play("turn"));
        for (int i = 0; i < count; ++i)
        {
            const auto instance = crowd->add(osg::Matrix::translate(0.2 * (i % 9), 0, 1), controller);
            if (!isLooking) continue;
            EXPECT_TRUE(crowd->constraint(instance.value(), "look").setWorldTarget(osg::Vec3d(1, -9, 2)));
        }
        return crowd;
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
    const char* const allowed[] = {"glDrawArrays",
                                   "glDrawArraysInstanced",
                                   "glBeginTransformFeedback",
                                   "glEndTransformFeedback",
                                   "glBufferData",
                                   "glBufferSubData",
                                   "glUniform1i"};
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

TEST_F(FrameCallsGLTest, levelsOfAPoseSetNoStateAnew)
{
    const osg::ref_ptr<AnimatedCharacter> deep = deepCharacter();
    const auto levels = static_cast<int>(deep->getAnimationSet().levelCount());
    std::map<std::string, int> calls = callsOfAFrame(deep);
    EXPECT_EQ(calls["glBeginTransformFeedback"], levels);
    EXPECT_EQ(calls["glVertexAttribDivisor"], 0);
    EXPECT_EQ(calls["glUniform1i of a uniform that is not there"], 0);
    EXPECT_LE(calls["glUniform1i"], levels + 6) << "the level's first parent; the draw's palette";
}

TEST_F(FrameCallsGLTest, instancesThatLookAtAPointCostOneFeedbackDrawTogether)
{
    constexpr int count = 10000;
    PosePipeline::of(state())->options().chunkSize = 2 * count; // one chunk
    std::map<std::string, int> plain = callsOfAFrame(crowdOf(count, false));
    std::map<std::string, int> looking = callsOfAFrame(crowdOf(count, true));
    EXPECT_EQ(looking["glBeginTransformFeedback"], plain["glBeginTransformFeedback"] + 1);
    EXPECT_EQ(looking["glDrawArrays"] + looking["glDrawArraysInstanced"],
              plain["glDrawArrays"] + plain["glDrawArraysInstanced"] + 1);
    for (const auto& [name, calls] : looking)
        EXPECT_EQ(plain.count(name), 1u) << name << " is called " << calls << " times in a frame";
}

struct FeedbackCase
{
    const char* name;
    PosePipeline::Form form;
    std::size_t chunkSize;
    bool hasCrowd; ///< with tints
    bool isLooking = false;
};

const FeedbackCase feedbackCases[] = {
    {"fused", PosePipeline::Form::Fused, PosePipeline::usualChunkSize, false},
    {"fused, a crowd", PosePipeline::Form::Fused, PosePipeline::usualChunkSize, true},
    {"fused, three chunks, a crowd", PosePipeline::Form::Fused, 4, true},
    {"fused, three chunks, constraints", PosePipeline::Form::Fused, 4, false, true},
    {"separate", PosePipeline::Form::Separate, PosePipeline::usualChunkSize, false},
    {"separate, three chunks, a crowd", PosePipeline::Form::Separate, 4, true},
};

TEST_F(FrameCallsGLTest, noBufferThatFeedbackWritesHasAnotherBinding)
{
    PosePipeline::Options& options = PosePipeline::of(state())->options();
    for (const FeedbackCase& each : feedbackCases)
    {
        SCOPED_TRACE(each.name);
        options.form = each.form;
        options.chunkSize = each.chunkSize;
        viewer().getCamera()->setFinalDrawCallback(nullptr);
        const osg::ref_ptr<osg::Group> scene = movingScene(each.hasCrowd);
        if (each.isLooking) scene->addChild(crowdOf(9, true));
        viewer().setSceneData(scene);
        drawAt(0.0);
        const GlCallTrace trace(state());
        for (const double time : {0.1, 0.2, 0.3})
            drawAt(time);
        EXPECT_GE(trace.feedbackDraws(), 9);
        for (const std::string& conflict : trace.feedbackConflicts())
            ADD_FAILURE() << conflict;
    }
}

} // namespace

} // namespace osgGpuAnimation
