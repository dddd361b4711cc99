// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/RandomLayers.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/buffers/InstanceTransforms.h>
#include <osgGpuAnimation/gpu/passes/FeedbackTimer.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/GLExtensions>

#include <chrono>
#include <random>

// What the pose side creates in a context: deleted in the end, made again afterwards.

namespace osgGpuAnimation
{

namespace
{

class GlObjectsOfPosesGLTest : public GLTest
{
protected:
    /// The number of buffers, textures, programs, vertex arrays and queries.
    int objects()
    {
        const osg::GLExtensions& gl = *state().get<osg::GLExtensions>();
        int count = 0;
        for (GLuint name = 1; name < 3000; ++name)
            count += (gl.glIsBuffer(name) != 0) + (glIsTexture(name) != 0) + (gl.glIsProgram(name) != 0) +
                     (gl.glIsVertexArray(name) != 0) + (gl.glIsQuery(name) != 0);
        return count;
    }
};

TEST_F(GlObjectsOfPosesGLTest, allThatAPipelineHasMadeIsDeletedAndMadeAgain)
{
    const int before = objects();
    const auto plain = makeRandomSet({});
    const std::string first = plain->skeleton().joint(0).name, second = plain->skeleton().joint(3).name;
    const auto set = plain->withConstraints({LookAt{"first", {first}}, LookAt{"second", {second}}}).value();
    std::mt19937 random(5);
    addRandomMasks(*set, random);
    const auto pose = std::make_shared<JointPose>(set);
    ASSERT_TRUE(pose->setTranslation(1, glm::vec3(1, 2, 3)));
    PosePipeline* pipeline = PosePipeline::of(state());
    for (int round = 0; round < 2; ++round)
        for (const PosePipeline::Form form : {PosePipeline::Form::Fused, PosePipeline::Form::Separate})
            for (const bool isLooking : {false, true})
            {
                SCOPED_TRACE(testing::Message() << "round " << round << (isLooking ? ", looking" : ""));
                PoseInstruction stack = instructionAt(*set, 0, 0.5);
                stack.samples[0].control |= 1u << 16;
                stack.samples[1] = {0, 0.0f, 0.5f, 16u | 8u};
                stack.sampleCount = 2;
                stack.poses.push_back(pose);
                if (isLooking) stack.targets.assign(2, {{30, 20, 10}, 1.0f, {0, 0, 0}, 0.0f, {0, 0, 0, 0}});
                pipeline->options().form = form;
                PoseBatch batch(set);
                AffineMatrix aside;
                aside.rows[1].w = 2.0f;
                for (int instance = 0; instance < 5; ++instance)
                    batch.add(stack, aside);
                batch.setTint(2, 0xff0000ffu);
                ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
                std::vector<AffineMatrix> twin;
                Pose::evaluate(*set, stack, aside, twin);
                const std::vector<AffineMatrix> palette = pipeline->readPalette(state(), *set, 0, 4);
                ASSERT_EQ(palette.size(), twin.size());
                for (std::size_t entry = 0; entry < twin.size(); ++entry)
                    for (std::size_t row = 0; row < 3; ++row)
                        for (int column = 0; column < 4; ++column)
                            ASSERT_NEAR(palette[entry].rows[row][column], twin[entry].rows[row][column], 1e-4f);
                if (!isLooking) continue;
                EXPECT_GT(objects(), before + 10);
                pipeline->deleteAllGLObjects();
                EXPECT_EQ(objects(), before);
                EXPECT_EQ(pipeline->place(*set, 0, 0).texture, 0u);
            }
}

TEST_F(GlObjectsOfPosesGLTest, listsOfInstancesKeepTheirContent)
{
    osg::GLExtensions& gl = *state().get<osg::GLExtensions>();
    InstanceTransformBuffers& lists = InstanceTransformBuffers::of(state());
    const int before = objects();
    for (int round = 0; round < 2; ++round)
    {
        for (const std::uint64_t serial : {1, 2, 1, 3, 1, 2, 3, 1})
        {
            std::vector<InstanceTransform> transforms(serial);
            for (InstanceTransform& transform : transforms)
                transform.pose = static_cast<float>(serial);
            const BufferTexture& buffer = lists.buffer(serial, transforms);
            InstanceTransform found;
            gl.glBindBuffer(GL_ARRAY_BUFFER, buffer.buffer());
            gl.glGetBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>((serial - 1) * sizeof found), sizeof found,
                                  &found);
            gl.glBindBuffer(GL_ARRAY_BUFFER, 0);
            EXPECT_EQ(found.pose, static_cast<float>(serial)) << "round " << round;
        }
        lists.deleteAllGLObjects();
        EXPECT_EQ(objects(), before);
    }
}

TEST_F(GlObjectsOfPosesGLTest, aTimerMeasuresItsFrames)
{
    const int before = objects();
    FeedbackTimer& timer = FeedbackTimer::of(state());
    const auto set = makeRandomSet({});
    PosePipeline* pipeline = PosePipeline::of(state());
    const auto seconds = []
    { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); };
    for (int round = 0; round < 2; ++round)
    {
        const double begin = seconds();
        for (unsigned int frame = 40; frame < 60; ++frame) // more than there may be unfinished
        {
            PoseBatch batch(set);
            batch.add(instructionAt(*set, 0, 0.01 * frame + round));
            timer.begin();
            ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
            timer.end(frame);
        }
        glFinish();
        const std::vector<FeedbackTimer::Measured> measured = timer.takeFinished();
        ASSERT_EQ(measured.size(), 16u);
        double sum = 0.0;
        for (std::size_t i = 0; i < measured.size(); ++i)
        {
            EXPECT_EQ(measured[i].frameNumber, 40 + i);
            EXPECT_GE(measured[i].seconds, 0.0);
            sum += measured[i].seconds;
        }
        EXPECT_GT(sum, 1e-7);
        EXPECT_LE(sum, seconds() - begin);
        EXPECT_TRUE(timer.takeFinished().empty()) << "taken";
    }
    timer.deleteAllGLObjects();
    pipeline->deleteAllGLObjects();
    EXPECT_EQ(objects(), before);
}

} // namespace

} // namespace osgGpuAnimation
