// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/authoring/CompactClips.h>
#include <osgGpuAnimation/gpu/buffers/InstanceTransforms.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
#include <osgGpuAnimation/gpu/passes/FeedbackTimer.h>

#include "gpu/PoseGLTest.h"
#include "support/ClipSets.h"
#include "support/NotifyLog.h"
#include "support/RandomSet.h"

#include <layout.glsl>

#include <osg/GLExtensions>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

struct Instance
{
    PoseInstruction instruction;
    AffineMatrix root;
};

std::vector<Instance> randomInstances(const AnimationSet& set, std::size_t count, unsigned int seed)
{
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> clip(-1, static_cast<int>(set.clips().size()) - 1);
    std::uniform_real_distribution<double> time(-0.2, 4.0);
    std::uniform_real_distribution<float> place(-3.0f, 3.0f);
    std::vector<Instance> instances(count);
    for (Instance& instance : instances)
    {
        instance.instruction = instructionAt(set, clip(random), time(random));
        instance.root.rows[0] = glm::vec4(0, 1, 0, place(random));
        instance.root.rows[1] = glm::vec4(-1, 0, 0, place(random));
    }
    return instances;
}

/// The root matrices of a batch.
enum class Roots
{
    None,
    Own, ///< one per instance
    One, ///< the first instance's for all
};

struct PipelineData
{
    const char* name;
    RandomSetShape shape;
    std::size_t instances;
    Roots roots;
    std::size_t maxTexels;   ///< 0: the context's own
    bool hasGarments{false}; ///< further entries of joints of all levels
};

const PipelineData pipelineData[] = {
    {"one character", {1, 30, 8, 5, false, false, false}, 1, Roots::None, 0},
    {"many, each at its own time", {2, 30, 8, 5, false, true, true}, 100, Roots::None, 0},
    {"with root matrices", {3, 30, 8, 5, false, true, true}, 37, Roots::Own, 0},
    {"splines", {4, 30, 8, 4, true, true, true}, 20, Roots::Own, 0},
    {"one joint", {5, 1, 1, 3, false, false, false}, 3, Roots::None, 0},
    {"a chain of 64", {6, 64, 64, 2, false, false, false}, 10, Roots::None, 0},
    {"in chunks, as with 65,536 texels", {7, 20, 6, 2, false, false, true}, 2500, Roots::Own, 65536},
    {"with one root matrix for all", {8, 30, 8, 5, false, true, true}, 37, Roots::One, 0},
    {"one character with a root matrix", {9, 30, 8, 5, false, false, true}, 1, Roots::One, 0},
    {"one root matrix, in chunks", {7, 20, 6, 2, false, false, true}, 2500, Roots::One, 65536},
    {"with garments", {11, 30, 8, 5, false, true, true}, 37, Roots::Own, 0, true},
    {"with garments, on one joint", {12, 1, 1, 3, false, false, false}, 3, Roots::None, 0, true},
    {"with garments, in chunks", {13, 20, 6, 2, false, false, true}, 2500, Roots::One, 65536, true},
};

/// The set with two garments, whose binds are those of its own entries, shifted.
std::shared_ptr<const AnimationSet> withGarments(const AnimationSet& set)
{
    std::vector<Skin> garments(2);
    for (std::size_t e = 0; e < set.paletteSize(); ++e)
    {
        const PaletteEntry& entry = set.palette()[e];
        if (entry.kind == PaletteEntry::Kind::Weights) continue;
        Skin& garment = garments[e % 2];
        garment.joints.push_back(entry.joint);
        garment.inverseBinds.push_back(entry.inverseBind);
        garment.inverseBinds.back().rows[1].w += 0.25f;
    }
    return set.withGarments(garments).value();
}

using PosePipelineGLTest = PoseFormsGLTest;

TEST_P(PosePipelineGLTest, agreesWithTheCpuTwin)
{
    const std::size_t ownTexels = pipeline->options().maxTexels;
    for (const PipelineData& data : pipelineData)
    {
        SCOPED_TRACE(data.name);
        const auto bare = makeRandomSet(data.shape);
        const auto set = data.hasGarments ? withGarments(*bare) : bare;
        ASSERT_EQ(set->paletteSize() > bare->paletteSize(), data.hasGarments);
        const std::vector<Instance> instances = randomInstances(*set, data.instances, data.shape.seed + 100);
        PoseBatch batch(set);
        if (data.roots == Roots::One) batch.setRootMatrix(instances.front().root);
        for (const Instance& instance : instances)
            data.roots == Roots::Own ? batch.add(instance.instruction, instance.root) : batch.add(instance.instruction);
        pipeline->options().maxTexels = data.maxTexels != 0 ? data.maxTexels : ownTexels;
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));

        // Rounding in float32 once a level, the twin computes in double.
        const double tolerance = 1e-7 * (10 + data.shape.depth);
        const std::size_t step = instances.size() / 50 + 1;
        for (std::size_t i = 0; i < instances.size(); i += step)
        {
            AffineMatrix root;
            if (data.roots != Roots::None) root = instances[data.roots == Roots::Own ? i : 0].root;
            EXPECT_LT(differenceFromTwin(*set, instances[i].instruction, i, root), tolerance) << "instance " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, PosePipelineGLTest, eachForm, nameOfForm);

using PosePipelineCostGLTest = PoseGLTest;

// Chunks are padded to whole triangles: the padding counts too.
TEST_F(PosePipelineCostGLTest, palettesFitTheLargestTextureBuffer)
{
    const auto set = makeRandomSet({7, 20, 6, 2, false, false, true});
    const std::size_t texels = POSE_TEXELS_PER_MATRIX * set->paletteSize(); // an instance
    const std::size_t least = PackedKeyframes(*set).texels().size() / texels + 1;
    for (std::size_t capacity = least; capacity < least + 4; ++capacity)
    {
        pipeline->options().maxTexels = capacity * texels;
        PoseBatch batch(set);
        for (std::size_t i = 0; i < 3 * capacity; ++i)
            batch.add(PoseInstruction());
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        for (std::size_t i = 0; i < batch.size(); ++i)
        {
            const PalettePlace place = pipeline->place(*set, 0, i);
            ASSERT_NE(place.texture, 0u);
            EXPECT_LE(static_cast<std::size_t>(place.stride) * texels, capacity * texels);
        }
    }
}

TEST_F(PosePipelineCostGLTest, drawsDependOnTheSetAloneNotOnTheNumberOfCharacters)
{
    const auto set = makeRandomSet({});
    pipeline->options().form = PosePipeline::Form::Fused;
    for (const std::size_t count : {1, 10, 100})
    {
        PoseBatch batch(set);
        for (const Instance& instance : randomInstances(*set, count, 1))
            batch.add(instance.instruction);
        const PosePipeline::Counters cost = costOf(batch);
        EXPECT_EQ(cost.feedbackDraws, set->levelCount());
        EXPECT_EQ(cost.bytesUploaded, 16 * count);
        const PosePipeline::Counters again = costOf(batch);
        EXPECT_EQ(again.feedbackDraws + again.bytesUploaded, 0u) << "unchanged";
    }
}

/// One draw per level, or three if the set has more levels and the batch few entries.
TEST_F(PosePipelineCostGLTest, smallBatchesOfDeepSetsTakeThreeDraws)
{
    const auto flat = makeRandomSet({1, 20, 1}), deep = makeRandomSet({2, 20, 8});
    const std::size_t levels = deep->levelCount(), width = 3 * 4; // whole triangles
    ASSERT_GT(levels, 3u);
    ASSERT_LE(flat->levelCount(), 3u);
    const std::size_t entries = std::max(deep->paletteSize(), deep->trackCount()) * width;
    EXPECT_GT(pipeline->options().entriesWorthADraw, 0u);
    struct Case
    {
        std::shared_ptr<const AnimationSet> set;
        std::size_t entriesWorthADraw, draws;
    };
    std::size_t slot = 0;
    for (const Case& each :
         {Case{deep, entries * levels / (8 * (levels - 3)) + 1, 3},
          Case{deep, (entries * levels - 1) / (8 * (levels - 3)), levels}, Case{flat, 1000000, flat->levelCount()}})
    {
        pipeline->options().entriesWorthADraw = each.entriesWorthADraw;
        PoseBatch batch(each.set);
        for (const Instance& instance : randomInstances(*each.set, width, 1))
            batch.add(instance.instruction);
        const std::uint64_t before = pipeline->getCounters().feedbackDraws;
        ASSERT_TRUE(pipeline->evaluate(state(), batch, slot++));
        EXPECT_EQ(pipeline->getCounters().feedbackDraws - before, each.draws);
    }
    PoseBatch batch(deep);
    batch.add(PoseInstruction());
    const std::uint64_t before = pipeline->getCounters().feedbackDraws;
    ASSERT_TRUE(pipeline->evaluateInEachForm(state(), batch, slot));
    EXPECT_EQ(pipeline->getCounters().feedbackDraws - before, 3 + levels);
}

TEST_F(PosePipelineCostGLTest, sendsTheRootsThatMovedAlone)
{
    const auto set = makeRandomSet({});
    std::vector<Instance> instances = randomInstances(*set, 100, 1);
    for (const std::vector<std::size_t>& moved : {std::vector<std::size_t>{}, {0}, {57}, {99}, {40, 60}, {0, 99}})
    {
        for (const std::size_t i : moved)
            instances[i].root.rows[0].w += 1.0f;
        PoseBatch batch(set);
        for (const Instance& instance : instances)
            batch.add(instance.instruction, instance.root);
        const std::size_t sent = moved.empty() ? 100 * (16 + 48) : (moved.back() - moved.front() + 1) * 48;
        EXPECT_EQ(costOf(batch).bytesUploaded, sent);
        for (const std::size_t i : {0, 40, 57, 99})
            EXPECT_LT(differenceFromTwin(*set, instances[i].instruction, i, instances[i].root), 2e-6) << i;
    }
}

/// Fails if the environment asks for a lesser driver and the driver ignores it.
TEST_F(PosePipelineCostGLTest, seesALesserDriver)
{
    const auto variable = [](const char* name) -> std::string
    {
        const char* const value = std::getenv(name);
        return value ? value : "";
    };
    if (variable("MESA_EXTENSION_OVERRIDE").find("-GL_ARB_base_instance") != std::string::npos)
    {
        EXPECT_FALSE(pipeline->options().usesBaseInstances);
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))).substr(0, 3), "3.3");
    }
    if (const std::string texels = variable("OSGGPUANIMATION_MAX_TEXELS"); !texels.empty())
    {
        EXPECT_EQ(std::to_string(pipeline->options().maxTexels), texels);
    }
}

/// The vertex array object keeps what a batch has bound, for the batches of other sets, roots and samples after it too.
TEST_F(PosePipelineCostGLTest, batchesByTurnsKeepTheirOwnInputsWithAndWithoutBaseInstances)
{
    osg::GLExtensions& gl = *state().get<osg::GLExtensions>();
    const auto baseInstance = gl.glDrawArraysInstancedBaseInstance;
    const std::shared_ptr<const AnimationSet> sets[] = {makeRandomSet({2, 30, 8, 5, false, true, true}),
                                                        makeRandomSet({3, 12, 4, 5, false, false, true})};
    const Roots roots[] = {Roots::None, Roots::Own, Roots::One, Roots::Own, Roots::None};
    for (unsigned int step = 0; step < 60; ++step)
    {
        gl.glDrawArraysInstancedBaseInstance = step % 7 < 3 ? nullptr : baseInstance;
        pipeline->options().usesBaseInstances = FeedbackPass::canOffsetInstances(gl);
        pipeline->options().drawsTriangles = step % 5 < 3;
        const bool isOnePalette = step >= 40; // whose buffers stay the same
        const auto& set = sets[step % 3 == 0 && !isOnePalette ? 1 : 0];
        const std::size_t slot = isOnePalette ? 0 : step % 4;
        const Roots kind = roots[step % 5];
        const std::vector<Instance> instances = randomInstances(*set, 1 + step % 9, step);
        AnimationController blended(set); // several samples per instance
        ASSERT_TRUE(blended.play(0) && blended.crossfade(1, 1.0));
        blended.advance(0.3);
        PoseBatch batch(set);
        if (kind == Roots::One) batch.setRootMatrix(instances[0].root);
        for (std::size_t i = 0; i < instances.size(); ++i)
        {
            const PoseInstruction& instruction = step % 2 != 0 ? blended.instruction() : instances[i].instruction;
            kind == Roots::Own ? batch.add(instruction, instances[i].root) : batch.add(instruction);
        }
        ASSERT_TRUE(pipeline->evaluate(state(), batch, slot));
        for (std::size_t i = 0; i < instances.size(); ++i)
        {
            const PoseInstruction& instruction = step % 2 != 0 ? blended.instruction() : instances[i].instruction;
            const AffineMatrix root = kind == Roots::None ? AffineMatrix() : instances[kind == Roots::Own ? i : 0].root;
            EXPECT_LT(differenceFromTwin(*set, instruction, i, root, slot), 4e-6) << step << ", " << i;
        }
    }
    gl.glDrawArraysInstancedBaseInstance = baseInstance;
}

void GL_APIENTRY beginNothing(GLenum) {}
void GL_APIENTRY endNothing() {}

/// A context whose feedback leaves its buffers as they are.
class BrokenFeedbackGLTest : public PoseGLTest, public ::testing::WithParamInterface<bool>
{
};

/// Found before the first pass, and all poses are the twin's. The parameter: GL reports an error, too.
TEST_P(BrokenFeedbackGLTest, theCpuComputesThePoses)
{
    osg::GLExtensions& gl = *state().get<osg::GLExtensions>();
    const auto begin = gl.glBeginTransformFeedback;
    const auto end = gl.glEndTransformFeedback;
    gl.glBeginTransformFeedback = beginNothing;
    if (!GetParam()) gl.glEndTransformFeedback = endNothing;
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
    osg::setNotifyHandler(log);
    const auto set = makeRandomSet({2, 30, 8, 5, false, true, true});
    for (const PosePipeline::Form form : {PosePipeline::Form::Automatic, PosePipeline::Form::Fused})
    {
        pipeline->options().form = form;
        const std::vector<Instance> instances = randomInstances(*set, 40, form == PosePipeline::Form::Fused ? 1 : 2);
        PoseBatch batch(set);
        for (const Instance& instance : instances)
            batch.add(instance.instruction, instance.root);
        ASSERT_TRUE(pipeline->evaluateInEachForm(state(), batch, 0));
        for (std::size_t i = 0; i < instances.size(); ++i)
            EXPECT_LE(differenceFromTwin(*set, instances[i].instruction, i, instances[i].root), 1e-7) << i;
    }
    EXPECT_EQ(pipeline->getCounters().feedbackDraws, 0u);
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
    gl.glBeginTransformFeedback = begin;
    gl.glEndTransformFeedback = end;
    const std::string text = "the CPU computes all poses";
    EXPECT_NE(log->text.find(text), std::string::npos) << log->text;
    EXPECT_EQ(log->text.find(text), log->text.rfind(text)) << "one warning";
}

INSTANTIATE_TEST_SUITE_P(Errors, BrokenFeedbackGLTest, ::testing::Bool());

using ShaderSource = void(GL_APIENTRY*)(GLuint, GLsizei, const GLchar**, const GLint*);
ShaderSource realShaderSource = nullptr;

void GL_APIENTRY faultyShaderSource(GLuint shader, GLsizei, const GLchar**, const GLint*)
{
    const char* text = "#version 330\nvoid main() { nothing of this name }\n";
    realShaderSource(shader, 1, &text, nullptr);
}

TEST_F(PosePipelineCostGLTest, aPassThatDoesNotCompileLeavesNoPalette)
{
    const auto set = makeRandomSet({});
    osg::GLExtensions* gl = state().get<osg::GLExtensions>();
    for (const PosePipeline::Form form : {PosePipeline::Form::Fused, PosePipeline::Form::Separate})
    {
        pipeline->deleteAllGLObjects();
        pipeline->options().form = form;
        PoseBatch single(set), layered(set);
        single.add(instructionAt(*set, 0, 0.5));
        PoseInstruction two = instructionAt(*set, 0, 0.5);
        two.samples[1] = two.samples[0];
        two.sampleCount = 2;
        layered.add(two);
        ASSERT_TRUE(pipeline->evaluate(state(), single, 0));
        EXPECT_NE(pipeline->place(*set, 0, 0).texture, 0u);

        // The variant of two samples is not there yet.
        realShaderSource = gl->glShaderSource;
        gl->glShaderSource = faultyShaderSource;
        for (int frame = 0; frame < 3; ++frame)
        {
            EXPECT_FALSE(pipeline->evaluate(state(), layered, 0)) << "frame " << frame;
            EXPECT_EQ(pipeline->place(*set, 0, 0).texture, 0u) << "not the pose of before";
        }
        gl->glShaderSource = realShaderSource;
        ASSERT_TRUE(pipeline->evaluate(state(), single, 0));
        EXPECT_NE(pipeline->place(*set, 0, 0).texture, 0u);
    }
}

/// A set without clips, whose palette entries take more room than its keyframes.
std::shared_ptr<const AnimationSet> jointsAlone(const std::vector<Constraint>& constraints, int count)
{
    return AnimationSet::create({Skeleton::create(chainOf(count)).value(), {}, {0}, {}, {}, constraints}).value();
}

TEST_F(PosePipelineCostGLTest, aSetThatFillsTheBufferTextureIsTaken)
{
    for (const auto& [hasClips, isCompact] : {std::pair(true, false), std::pair(true, true), std::pair(false, false)})
    {
        const auto makeSet = [has = hasClips, compact = isCompact]
        {
            const auto exact = has ? makeRandomSet({}) : jointsAlone({}, 40);
            return compact ? compactClips(*exact, cubes(*exact, 0.1f), {1e-3}).value().set : exact;
        };
        const std::size_t keyframes = PackedKeyframes(*makeSet()).texels().size();
        const std::size_t entries = makeSet()->paletteSize() * POSE_TEXELS_PER_ENTRY;
        ASSERT_EQ(keyframes > entries, hasClips);
        const std::size_t needed = std::max(keyframes, entries);
        for (const std::size_t room : {needed, needed - 1})
        {
            const auto set = makeSet();
            pipeline->options().maxTexels = room;
            PoseBatch batch(set);
            batch.add({});
            const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
            osg::setNotifyHandler(log);
            for (int frame = 0; frame < 2; ++frame)
            {
                EXPECT_EQ(pipeline->evaluate(state(), batch, 0), room == needed) << needed - room;
                EXPECT_EQ(pipeline->place(*set, 0, 0).texture != 0u, room == needed);
            }
            osg::setNotifyHandler(new osg::StandardNotifyHandler);
            const std::string text = "texels (keyframes)";
            EXPECT_EQ(log->text.find(text) != std::string::npos, room < needed) << log->text;
            EXPECT_EQ(log->text.find(text), log->text.rfind(text)) << "one warning";
            const bool mayBeSmaller = room < needed && hasClips && !isCompact;
            EXPECT_EQ(log->text.find("compact=") != std::string::npos, mayBeSmaller) << log->text;
        }
    }
}

TEST_F(PosePipelineCostGLTest, masksThatFillTheBufferTextureAreTaken)
{
    const auto set = makeRandomSet({});
    std::mt19937 random(1);
    addRandomMasks(*set, random);
    PoseInstruction instruction = instructionAt(*set, 0, 0.5);
    instruction.samples[0].control |= 1u << POSE_SAMPLE_MASK_SHIFT;
    PoseBatch batch(set);
    batch.add(instruction);
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    const std::size_t needed = batch.masks().size() * ((set->trackCount() + 3) / 4);
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
    osg::setNotifyHandler(log);
    for (const std::size_t room : {needed, needed - 1, needed - 1})
    {
        pipeline->options().maxTexels = room;
        EXPECT_EQ(pipeline->evaluate(state(), batch, 0), room == needed) << needed - room;
        EXPECT_EQ(pipeline->place(*set, 0, 0).texture != 0u, room == needed) << "not the pose of before";
    }
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
    EXPECT_NE(log->text.find("masks"), std::string::npos);
    EXPECT_EQ(log->text.find("masks"), log->text.rfind("masks")) << "one warning";
}

// Besides the palette, the blend samples and the targets of a chunk fit its buffer textures.
TEST_F(PosePipelineCostGLTest, samplesAndTargetsFitTheBufferTextureToo)
{
    std::vector<Constraint> looks;
    for (int look = 0; look < 8; ++look)
        looks.push_back(LookAt{"look" + std::to_string(look), {"joint 0"}});
    pipeline->options().maxTexels = 1000;
    for (const bool hasTargets : {false, true})
    {
        const auto set = jointsAlone(hasTargets ? looks : std::vector<Constraint>(), 2);
        PoseInstruction instruction = instructionAt(*set, -1, 0.0);
        if (hasTargets) instruction.targets.assign(looks.size(), {{1, 2, 3}, 1.0f, {0, 0, 0}, 0.0f, {0, 0, 0, 0}});
        for (; !hasTargets && instruction.sampleCount < PoseInstruction::maxSamples; ++instruction.sampleCount)
            instruction.samples[instruction.sampleCount] = instruction.samples[0];
        PoseBatch batch(set);
        for (int i = 0; i < 400; ++i)
            batch.add(instruction);
        const std::size_t texels = hasTargets ? looks.size() * POSE_TEXELS_PER_TARGET : PoseInstruction::maxSamples;
        ASSERT_GT(texels, set->paletteSize() * POSE_TEXELS_PER_MATRIX);
        EXPECT_EQ(costOf(batch).instancesEvaluated, 400u) << "each in its chunk";
        for (std::size_t i = 0; i < batch.size(); ++i)
            ASSERT_LE(static_cast<std::size_t>(pipeline->place(*set, 0, i).stride) * texels, 1000u) << i;
    }
}

TEST_F(PosePipelineCostGLTest, forgetsSetsThatNobodyUses)
{
    const AnimationSet* gone = nullptr;
    {
        const auto set = makeRandomSet({});
        gone = set.get();
        PoseBatch batch(set);
        batch.add({});
        pipeline->evaluate(state(), batch, 0);
        EXPECT_NE(pipeline->place(*set, 0, 0).texture, 0u);
    }
    pipeline->flushAllDeletedGLObjects();
    EXPECT_EQ(pipeline->place(*gone, 0, 0).texture, 0u);
}

/// What the pose side creates in a context: deleted in the end, made again afterwards.
class GlObjectsOfPosesGLTest : public PoseGLTest
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
                ASSERT_LE(differenceFromTwin(*set, stack, 4, aside), 1e-5);
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
    std::vector<InstanceLists::value_type> listOf; // list i: i instances of pose i
    for (std::size_t i = 0; i < 4; ++i)
        listOf.push_back(std::make_shared<const std::vector<InstanceTransform>>(
            i, InstanceTransform{AffineMatrix(), static_cast<float>(i)}));
    for (int round = 0; round < 2; ++round)
    {
        for (const std::vector<std::size_t>& numbers :
             std::vector<std::vector<std::size_t>>{{1}, {1, 2}, {1}, {3, 1}, {1}, {1, 2}, {3, 1}, {1}})
        {
            InstanceLists joined;
            for (const std::size_t number : numbers)
                joined.push_back(listOf[number]);
            const BufferTexture& buffer = *lists.joined(joined, true).buffer;
            std::vector<InstanceTransform> found(numbers.front() + (numbers.size() > 1 ? numbers.back() : 0));
            gl.glBindBuffer(GL_ARRAY_BUFFER, buffer.buffer());
            gl.glGetBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(found.size() * sizeof found[0]),
                                  found.data());
            gl.glBindBuffer(GL_ARRAY_BUFFER, 0);
            EXPECT_EQ(found.front().pose, static_cast<float>(numbers.front())) << "round " << round;
            EXPECT_EQ(found.back().pose, static_cast<float>(numbers.back())) << "round " << round;
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
        if (!state().get<osg::GLExtensions>()->isARBTimerQuerySupported)
        {
            EXPECT_TRUE(measured.empty());
            continue;
        }
        ASSERT_EQ(measured.size(), 16u);
        double sum = 0.0;
        for (std::size_t i = 0; i < measured.size(); sum += measured[i++].seconds)
            EXPECT_EQ(measured[i].frameNumber, 40 + i);
        EXPECT_GT(sum, 1e-7);
        EXPECT_LE(sum, seconds() - begin);
        EXPECT_TRUE(timer.takeFinished().empty()) << "taken";
    }
    timer.deleteAllGLObjects();
    pipeline->deleteAllGLObjects();
    EXPECT_EQ(objects(), before);
}

void GL_APIENTRY noClock(GLenum, GLenum, GLint* bits)
{
    *bits = 0;
}

TEST_F(GlObjectsOfPosesGLTest, aDriverWithoutAClockMeasuresNothing)
{
    osg::GLExtensions& gl = *state().get<osg::GLExtensions>();
    const auto getQuery = gl.glGetQueryiv;
    gl.glGetQueryiv = noClock;
    FeedbackTimer& timer = FeedbackTimer::of(state());
    gl.glGetQueryiv = getQuery;
    timer.begin();
    timer.end(1);
    glFinish();
    EXPECT_TRUE(timer.takeFinished().empty());
}

} // namespace

} // namespace osgGpuAnimation
