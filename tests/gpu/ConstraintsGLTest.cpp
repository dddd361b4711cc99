// SPDX-License-Identifier: MIT
#include "gpu/PoseGLTest.h"
#include "support/ClipSets.h"
#include "support/Limb.h"
#include "support/RandomSet.h"
#include "support/ReferencePose.h"
#include "support/Results.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

using ConstraintsGLTest = PoseGLTest;

} // namespace

TEST_F(ConstraintsGLTest, randomSettingsAreTheTwinsPose)
{
    constexpr unsigned int seed = 20261122;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    double worst = 0.0;
    std::size_t compared = 0;
    for (unsigned int character = 0; character < 5; ++character)
    {
        const auto set = withRandomConstraints(
            *makeRandomSet({seed + character, 24, 7, 5, character % 2 == 1, true, true}), 1 + 2 * character, random);
        addRandomMasks(*set, random);
        glm::dmat4 placed(glm::mat4_cast(glm::angleAxis(0.3 * character, glm::dvec3(0.6, 0.8, 0.0))) * 2.0);
        placed[3] = glm::dvec4(1.0, -2.0, 0.5, 1.0);
        const AffineMatrix root = AffineMatrix::fromColumns(placed);
        std::vector<PoseInstruction> stacks(100);
        PoseBatch batch(set);
        for (PoseInstruction& stack : stacks)
        {
            stack = randomLayers(*set, random);
            stack.targets = randomTargets(*set, random);
            character % 3 == 0 ? batch.add(stack) : batch.add(stack, root);
        }
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        pipeline->options().form = PosePipeline::Form::Cpu;
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 1));
        pipeline->options().form = PosePipeline::Form::Automatic;
        for (std::size_t i = 0; i < stacks.size(); ++i)
        {
            const AffineMatrix placement = character % 3 == 0 ? AffineMatrix() : root;
            const double found = std::max(differenceFromTwin(*set, stacks[i], i, placement),
                                          differenceFromTwin(*set, stacks[i], i, placement, 1));
            EXPECT_LT(found, 10.0) << "not finite";
            if (reference::blend(*set, stacks[i]).closestDecision < 1e-5) continue;
            const double sensitivity = sensitivityOf(*set, stacks[i], random);
            if (sensitivity > 57.0) continue;
            ++compared;
            worst = std::max(worst, found);
        }
    }
    std::printf("%zu compared, the worst by %.2e\n", compared, worst);
    EXPECT_GE(compared, 250u) << "of 500: the others are near singular axes";
    // Rounding of floats times the sensitivity of up to 57, over up to nine constraints.
    EXPECT_LE(worst, 3e-5);
}

// Declared before a constraint higher up, the limb does not see its result: the path begins above the limb.
TEST_F(ConstraintsGLTest, theOrderOfDeclarationIsTheTwins)
{
    const std::vector<Joint> joints{jointAt("hips", {0, 1, 0}), jointAt("chest", {0, 0.5f, 0}),
                                    jointAt("arm", {0.2f, 0, 0}), jointAt("elbow", {0.3f, 0, 0}),
                                    jointAt("hand", {0.2f, 0, 0.1f})};
    const TwoBoneIk reach{"reach", "arm", "elbow", "hand"};
    const LookAt look{"look", {"chest"}}, point{"point", {"elbow", "hand"}};
    const std::vector<std::vector<Constraint>> orders{{reach, look, point}, {look, reach, point}, {point, reach, look},
                                                      {point, look, reach}, {look, point, reach}, {reach, point, look}};
    for (const std::vector<Constraint>& order : orders)
    {
        const auto set = limbOf(joints, order).value();
        AnimationController controller(set);
        ASSERT_TRUE(controller.constraint("reach").setTarget({0.4f, 1.4f, 0.3f}));
        ASSERT_TRUE(controller.constraint("look").setTarget({3, 1.5f, 3}));
        ASSERT_TRUE(controller.constraint("point").setTarget({1, 2, 3}));
        EXPECT_LE(evaluatedDifference(set, controller.instruction()), 5e-6);
    }
}

// The path begins at the root, which no clip moves, and ends at a joint that slides and grows.
TEST_F(ConstraintsGLTest, jointsOfAPathMoveAsTheirLevelsDo)
{
    const auto bare =
        valueOf(limbOf({jointAt("root", {0, 1, 0}), jointAt("middle", {0, 0.5f, 0}), jointAt("tip", {0, 0.2f, 0})},
                       {LookAt{"look", {"root", "middle", "tip"}}}));
    const auto linear = Channel::Interpolation::Linear;
    const auto set = valueOf(bare->withClips(
        {clipOf(bare->skeleton(), {{Channel::Path::Translation, linear, 1, {0, 1}, {0, 0.5, 0, 0.7, 0.9, -0.3}},
                                   {Channel::Path::Scale, linear, 1, {0, 1}, {1, 1, 1, 1.5, 2.0, 0.8}}})}));
    PoseInstruction instruction = instructionAt(*set, 0, 0.6);
    instruction.targets.assign(1, {{2, 3, 1}, 1.0f, {0, 0, 0}, 0.0f, {0, 0, 0, 0}});
    EXPECT_LE(evaluatedDifference(set, instruction), 5e-6);
}

// Shaders read an end joint's rotation in the space of the palette.
TEST_F(ConstraintsGLTest, endRotationsFollowAnyRootMatrix)
{
    const auto set = limbOf({jointAt("hip", {0.1f, 1, 0}, glm::angleAxis(0.4, glm::dvec3(0.6, 0, 0.8))),
                             jointAt("knee", {0, -0.4f, 0.05f}), jointAt("foot", {0, -0.4f, -0.05f})},
                            {TwoBoneIk{"leg", "hip", "knee", "foot"}})
                         .value();
    AnimationController controller(set);
    ASSERT_TRUE(controller.constraint("leg").setTarget({0.2f, 0.4f, 0.1f}));
    ASSERT_TRUE(controller.constraint("leg").setRotation({0.5f, -0.1f, 0.7f, 0.5f}));
    const glm::dmat4 turn = glm::mat4_cast(glm::angleAxis(0.8, glm::dvec3(0.6, 0.8, 0.0)));
    glm::dmat4 sheared(1.0);
    sheared[1].x = 0.5;
    const std::pair<const char*, glm::dmat4> roots[] = {
        {"uniform", turn * glm::scale(glm::dmat4(1.0), glm::dvec3(2.0))},
        {"not uniform", turn * glm::scale(glm::dmat4(1.0), glm::dvec3(1.0, 2.0, 0.5))},
        {"mirrored", turn * glm::scale(glm::dmat4(1.0), glm::dvec3(1.0, -1.0, 1.0))},
        {"sheared", turn * sheared}};
    for (const PosePipeline::Form form : {PosePipeline::Form::Automatic, PosePipeline::Form::Cpu})
        for (const auto& [name, columns] : roots)
        {
            pipeline->options().form = form;
            const AffineMatrix root = AffineMatrix::fromColumns(columns);
            EXPECT_LE(evaluatedDifference(set, controller.instruction(), &root), 5e-6) << name;
        }
}

// As many draws as levels and constraints with a target; none more for batches without.
TEST_F(ConstraintsGLTest, onlyConstraintsWithTargetsCostADraw)
{
    const auto set = limbOf({jointAt("hips", {0, 1, 0}), jointAt("chest", {0, 0.5f, 0}), jointAt("head", {0, 0.2f, 0})},
                            {LookAt{"chest", {"chest"}}, LookAt{"head", {"head"}}})
                         .value();
    AnimationController controller(set);
    const auto drawsOf = [&](std::size_t count)
    {
        PoseBatch batch(set);
        for (std::size_t i = 0; i < count; ++i)
            batch.add(controller.instruction());
        const auto before = pipeline->getCounters();
        EXPECT_TRUE(pipeline->evaluate(state(), batch, 0));
        EXPECT_LE(differenceFromTwin(*set, controller.instruction(), count - 1), 1e-6);
        return pipeline->getCounters().feedbackDraws - before.feedbackDraws;
    };
    EXPECT_EQ(drawsOf(1), 3u);
    ASSERT_TRUE(controller.constraint("head").setTarget({1, 2, 3}));
    EXPECT_EQ(drawsOf(5), 4u);
    ASSERT_TRUE(controller.constraint("chest").setTarget({1, 2, 3}));
    EXPECT_EQ(drawsOf(1), 5u);
    ASSERT_TRUE(controller.constraint("head").setWeight(0.0f));
    EXPECT_EQ(drawsOf(7), 4u);
    ASSERT_TRUE(controller.constraint("chest").clear());
    EXPECT_EQ(drawsOf(2), 3u);
    // Nothing changed: nothing is drawn.
    EXPECT_EQ(drawsOf(2), 0u);
}

TEST_F(ConstraintsGLTest, constraintsOfBothSidesAreTheTwins)
{
    std::vector<Joint> joints{jointAt("hips", {0, 1, 0})};
    for (const char* side : {"left", "right"})
        for (const char* part : {"hip", "knee", "foot"})
        {
            joints.push_back(jointAt("", {side[0] == 'l' ? 0.1f : -0.1f, -0.4f, 0.02f}));
            joints.back().name = std::string(side) + " " + part;
            joints.back().parent = part[0] == 'h' ? 0 : static_cast<int>(joints.size()) - 2;
        }
    const TwoBoneIk left{"left", "left hip", "left knee", "left foot", {1, 0, 0}};
    const TwoBoneIk right{"right", "right hip", "right knee", "right foot", {1, 0, 0}};
    const LookAt toes{"toes", {"left foot"}}, knee{"knee", {"right knee"}}, hips{"hips", {"hips"}};
    struct Case
    {
        std::vector<Constraint> constraints;
        std::size_t dividedLevels; // entries with and without corrections take a draw each
    };
    const Case cases[] = {{{left}, 3},
                          {{left, right}, 0},
                          {{right, toes, left}, 0},
                          {{toes, right, knee, left}, 0},
                          {{left, right, hips}, 0},
                          {{hips, left, right}, 0}};
    for (const auto& [constraints, dividedLevels] : cases)
    {
        const auto set = AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, {}, constraints}).value();
        AnimationController controller(set);
        float away = 0.0f;
        for (const Constraint& constraint : constraints)
        {
            const std::string name = std::visit([](const auto& declared) { return declared.name; }, constraint);
            ASSERT_TRUE(controller.constraint(name).setTarget({0.3f - (away += 0.1f), 0.4f, 0.3f}));
        }
        PoseBatch batch(set);
        for (int instance = 0; instance < 4; ++instance)
            batch.add(controller.instruction());
        const auto before = pipeline->getCounters();
        ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
        EXPECT_EQ(pipeline->getCounters().feedbackDraws - before.feedbackDraws,
                  set->levelCount() + constraints.size() + dividedLevels);
        EXPECT_LE(differenceFromTwin(*set, controller.instruction(), 3), 5e-6);
    }
}

TEST_F(ConstraintsGLTest, chunksHaveTheirOwnTargets)
{
    const auto set =
        limbOf({jointAt("neck", {0, 1, 0}), jointAt("head", {0, 0.2f, 0})}, {LookAt{"look", {"neck", "head"}}}).value();
    pipeline->options().chunkSize = 7;
    PoseBatch batch(set);
    std::vector<AnimationController> controllers(40, AnimationController(set));
    for (std::size_t i = 0; i < controllers.size(); ++i)
    {
        ASSERT_TRUE(controllers[i].constraint("look").setTarget({std::sin(0.1f * static_cast<float>(i)), 1.5f, 1}));
        batch.add(controllers[i].instruction());
    }
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (std::size_t i = 0; i < controllers.size(); ++i)
        EXPECT_LE(differenceFromTwin(*set, controllers[i].instruction(), i), 1e-6) << i;
}

TEST_F(ConstraintsGLTest, instancesWithAndWithoutTargetsDoNotShareABatch)
{
    const auto set = limbOf({jointAt("head", {0, 1, 0})}, {LookAt{"look", {"head"}}}).value();
    AnimationController plain(set), looking(set);
    ASSERT_TRUE(looking.constraint("look").setTarget({1, 1, 1}));
    PoseBatch batch(set);
    EXPECT_TRUE(batch.accepts(looking.instruction()));
    batch.add(plain.instruction());
    EXPECT_FALSE(batch.accepts(looking.instruction()));
    EXPECT_TRUE(batch.accepts(plain.instruction()));
    batch.clear();
    batch.add(looking.instruction());
    EXPECT_TRUE(batch.accepts(looking.instruction()));
    EXPECT_FALSE(batch.accepts(plain.instruction()));
    // A caller may mix them all the same.
    batch.add(plain.instruction());
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    EXPECT_LE(differenceFromTwin(*set, looking.instruction(), 0), 1e-6);
    EXPECT_LE(differenceFromTwin(*set, plain.instruction(), 1), 1e-6);
}

// Numbers that no controller lets through: the instance keeps the mixed pose.
TEST_F(ConstraintsGLTest, noNumbersButGoodOnesReachThePalette)
{
    const auto set = limbOf({jointAt("a", {0, 1, 0}), jointAt("b", {0, 1, 0}), jointAt("c", {0, 1, 1})},
                            {LookAt{"look", {"a", "b"}}, TwoBoneIk{"limb", "a", "b", "c"}})
                         .value();
    const float nan = std::nanf(""), infinite = INFINITY;
    PoseBatch batch(set);
    std::vector<PoseInstruction> instructions;
    for (const glm::vec3& bad :
         {glm::vec3(nan, 0, 0), glm::vec3(infinite, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 2, 0), glm::vec3(0, 3, 1),
          glm::vec3(1e12f, -1e12f, 1e12f), glm::vec3(0, 1, 1e-30f), glm::vec3(0, -9, 0)})
    {
        PoseInstruction instruction;
        instruction.targets.assign(2, {bad, 1.0f, bad, 0.0f, {0, 0, 0, 0}});
        batch.add(instruction);
        instruction.targets.assign(2, {{1, 2, 3}, bad.x, {0, 0, 0}, bad.x, glm::vec4(bad, bad.x)});
        batch.add(instruction);
    }
    ASSERT_TRUE(pipeline->evaluate(state(), batch, 0));
    for (std::size_t instance = 0; instance < batch.size(); ++instance)
        for (const AffineMatrix& entry : pipeline->readPalette(state(), *set, 0, instance))
            EXPECT_TRUE(entry.isFinite()) << instance;
}

} // namespace osgGpuAnimation
