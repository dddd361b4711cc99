// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "support/RandomSet.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Geometry>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osg/Texture2D>
#include <osg/Texture>
#include <osgUtil/GLObjectsVisitor>
#include <osgUtil/IncrementalCompileOperation>

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
    if (!PosePipeline::of(state())->options().usesBaseInstances) calls.erase("glVertexAttribDivisor"); // rebound
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

TEST_F(FrameCallsGLTest, theFirstFrameOfManyCopiesHasNoMoreCallsOfItsOwnThanThatOfFew)
{
    const osg::ref_ptr<AnimatedCharacter> original = makeTestCharacter();
    callsOfAFrame(original);
    std::map<std::string, int> more[2]; // than in the second frame
    for (const bool isMany : {false, true})
    {
        const osg::ref_ptr<osg::Group> copies = new osg::Group;
        for (int i = 0; i < (isMany ? 1000 : 10); ++i)
            copies->addChild(osg::clone(original.get(), osg::CopyOp::DEEP_COPY_NODES));
        viewer().setSceneData(copies);
        for (const int sign : {1, -1})
        {
            const GlCallTrace trace(state());
            drawAt(sign > 0 ? 0.3 : 0.4);
            for (const auto& [name, count] : trace.calls())
                more[isMany][name] += sign * count;
        }
    }
    for (const auto& [name, count] : more[1])
        EXPECT_LE(count, more[0][name]) << name;
    EXPECT_EQ(more[1]["glLinkProgram"], 0);
}

TEST_F(FrameCallsGLTest, levelsOfAPoseSetNoStateAnew)
{
    const osg::ref_ptr<AnimatedCharacter> deep = deepCharacter();
    const auto levels = static_cast<int>(deep->getAnimationSet().levelCount());
    PosePipeline::of(state())->options().form = PosePipeline::Form::Fused;
    std::map<std::string, int> calls = callsOfAFrame(deep);
    EXPECT_EQ(calls["glBeginTransformFeedback"], levels);
    EXPECT_TRUE(calls["glVertexAttribDivisor"] == 0 || !PosePipeline::of(state())->options().usesBaseInstances);
    EXPECT_EQ(calls["glUniform1i of a uniform that is not there"], 0);
    EXPECT_LE(calls["glUniform1i"], levels + 6) << "the level's first parent; the draw's palette";
}

TEST_F(FrameCallsGLTest, instancesThatLookAtAPointCostOneFeedbackDrawTogether)
{
    constexpr int count = 2000; // one chunk, also of a driver with 65,536 texels
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

/// The first frame after a compile traversal.
class FirstDrawGLTest : public ViewerGLTest
{
protected:
    /// A new context and a viewer that has drawn an empty scene.
    osg::Group& beginAgain()
    {
        TearDown();
        SetUp();
        _root = new osg::Group;
        pictureOf(_root, {0.0});
        return *_root;
    }

    void compileAtOnce(osg::Node& node)
    {
        osgUtil::GLObjectsVisitor visitor;
        visitor.setState(&state());
        visitor.compile(node);
    }

    /// As a DatabasePager has it: traversed in one thread, compiled in the next frames.
    void compileByAndBy(osg::Node& node)
    {
        const osg::ref_ptr<osgUtil::IncrementalCompileOperation> operation = new osgUtil::IncrementalCompileOperation;
        operation->addGraphicsContext(&context());
        operation->add(new osgUtil::IncrementalCompileOperation::CompileSet(&node));
        for (int tries = 0; tries < 100 && !operation->getToCompile().empty(); ++tries)
        {
            operation->compileAllForNextFrame(1);
            (*operation)(&context());
        }
        EXPECT_TRUE(operation->getToCompile().empty());
        operation->removeGraphicsContext(&context());
    }

private:
    osg::ref_ptr<osg::Group> _root;
};

/// Characters beside each other, with a texture and state sets of their own and above.
osg::ref_ptr<osg::Node> makeRow(int count)
{
    const osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*first->getChild(0));
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(200));
    mesh.getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
    mesh.setColorArray(new osg::Vec4Array(osg::Array::BIND_OVERALL, 1));
    (*static_cast<osg::Vec4Array*>(mesh.getColorArray()))[0] = osg::Vec4(1, 0.5f, 0, 1);
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
    for (int i = 0; i < count; ++i)
    {
        osg::ref_ptr<AnimatedCharacter> each = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
        each->setMatrix(osg::Matrix::translate(1.2 * i - 3.0, 0, 0));
        group->addChild(each);
    }
    return group;
}

} // namespace

TEST_F(FirstDrawGLTest, theFirstFrameAfterACompileTraversalCompilesNothing)
{
    for (const int characters : {1, 3})
        for (const bool isAtOnce : {true, false})
        {
            SCOPED_TRACE(testing::Message() << characters << (isAtOnce ? ", by GLObjectsVisitor" : ", incremental"));
            beginAgain().addChild(makeRow(characters));
            osg::ref_ptr<osg::Image> expected;
            {
                const GlCallTrace trace(state());
                drawAt(0.5);
                expected = picture().copy();
                EXPECT_GT(trace.count("glLinkProgram"), 1) << "otherwise the trace sees none";
            }
            EXPECT_GT(picture().pixelsDrawn(), 50);
            osg::Group& root = beginAgain();
            const osg::ref_ptr<osg::Node> scene = makeRow(characters);
            isAtOnce ? compileAtOnce(*scene) : compileByAndBy(*scene);
            root.addChild(scene);
            const GlCallTrace trace(state());
            drawAt(0.5);
            EXPECT_EQ(trace.count("glCompileShader"), 0);
            EXPECT_EQ(trace.count("glLinkProgram"), 0);
            EXPECT_EQ(Picture::pixelsDifferent(*expected, picture().image()), 0);
            EXPECT_NO_GL_ERROR();
        }
}

// Applications compile more than once: when they attach a scene, and after each change of the graphics context.
TEST_F(FirstDrawGLTest, aCompileTraversalBetweenFramesChangesNoPicture)
{
    osg::Group& root = beginAgain();
    root.addChild(makeRow(3));
    root.addChild(osg::createTexturedQuadGeometry({-3, 0, -3}, {1, 0, 0}, {0, 0, 1}));
    drawAt(0.5);
    drawAt(0.5);
    const osg::ref_ptr<osg::Image> before = picture().copy(), shown = new osg::Image;
    // In clip space, where matrices that no frame has set would draw it, it covers the picture.
    const osg::ref_ptr<AnimatedCharacter> wide = makeTestCharacter();
    const osg::Vec3 corners[] = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*wide->getChild(0));
    mesh.setVertexArray(new osg::Vec3Array(4, const_cast<osg::Vec3*>(corners)));
    for (int round = 0; round < 3; ++round)
    {
        compileAtOnce(root);
        compileAtOnce(*wide);
        shown->readPixels(0, 0, before->s(), before->t(), before->getPixelFormat(), GL_UNSIGNED_BYTE);
        EXPECT_EQ(Picture::pixelsDifferent(*before, *shown), 0) << "it draws into the frame, round " << round;
        drawAt(0.5);
        EXPECT_EQ(Picture::pixelsDifferent(*before, picture().image()), 0) << round;
        EXPECT_NO_GL_ERROR();
        if (round == 1) root.releaseGLObjects(&state());
    }
}

} // namespace osgGpuAnimation
