// SPDX-License-Identifier: MIT
#include "support/GaitSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// hips > spine > (arm > hand, head), hips > leg; the weights "face" belong to the head's node, "hat" to no joint's.
std::shared_ptr<const AnimationSet> makeSet()
{
    const Skeleton skeleton = Skeleton::create({{"hips", -1, {}, 0},
                                                {"spine", 0, {}, 1},
                                                {"leg", 0, {}, 2},
                                                {"arm", 1, {}, 3},
                                                {"head", 1, {}, 4},
                                                {"hand", 3, {}, 5}})
                                  .value();
    const std::vector<MorphWeights> morphs{{"face", 4, std::vector<float>(14)}, {"hat", 9, {0.0f}}};
    return AnimationSet::create({skeleton, {}, {}, morphs, {}}).value();
}

std::vector<float> weightsOf(const Result<JointMask>& mask)
{
    EXPECT_TRUE(mask) << (mask ? "" : mask.error().message);
    return mask ? mask.value().weights() : std::vector<float>();
}

TEST(JointMaskTest, TakesASubtreeWithAFeatheredEdge)
{
    const auto set = makeSet();
    // Joints in level order: hips, spine, leg, arm, head, hand; then the face's two blocks and the hat's one.
    EXPECT_EQ(weightsOf(JointMask::subtree(*set, "spine")), (std::vector<float>{0, 1, 0, 1, 1, 1, 1, 1, 0}));
    EXPECT_EQ(weightsOf(JointMask::subtree(*set, "spine", 1)), (std::vector<float>{0, 0.5f, 0, 1, 1, 1, 1, 1, 0}));
    EXPECT_EQ(weightsOf(JointMask::subtree(*set, "spine", 3)),
              (std::vector<float>{0, 0.25f, 0, 0.5f, 0.5f, 0.75f, 0.5f, 0.5f, 0}));
    EXPECT_EQ(weightsOf(JointMask::subtree(*set, "leg", -3)), (std::vector<float>{0, 0, 1, 0, 0, 0, 0, 0, 0}));
}

TEST(JointMaskTest, TakesJointsByName)
{
    const auto set = makeSet();
    EXPECT_EQ(weightsOf(JointMask::joints(*set, {"arm", "hips"})), (std::vector<float>{1, 0, 0, 1, 0, 0, 0, 0, 0}));
    const Result<JointMask> faulty = JointMask::joints(*set, {"arm", "wing"});
    ASSERT_FALSE(faulty);
    EXPECT_EQ(faulty.error().message,
              "there is no joint \"wing\"; the joints are \"hips\", \"spine\", \"leg\", \"arm\", \"head\", \"hand\"");
    EXPECT_FALSE(JointMask::subtree(*set, "tail"));
}

TEST(JointMaskTest, HoldsNothingButWeightsFromZeroToOne)
{
    const auto set = makeSet();
    JointMask mask(*set, std::nanf(""));
    EXPECT_TRUE(mask.setJoint(0, 7.0f));
    EXPECT_TRUE(mask.setJoint(1, -7.0f));
    EXPECT_TRUE(mask.setJoint(2, std::nanf("")));
    EXPECT_TRUE(mask.setMorph(0, 0.25f));
    EXPECT_FALSE(mask.setJoint(6, 1.0f));
    EXPECT_FALSE(mask.setMorph(2, 1.0f));
    EXPECT_EQ(mask.weights(), (std::vector<float>{1, 0, 0, 0, 0, 0, 0.25f, 0.25f, 0}));
    EXPECT_EQ(mask.inverted().weights(), (std::vector<float>{0, 1, 1, 1, 1, 1, 0.75f, 0.75f, 1}));
}

TEST(JointMaskTest, EqualMasksAreStoredOnceInTheSet)
{
    const auto set = makeSet();
    const JointMask arm = JointMask::subtree(*set, "arm").value();
    EXPECT_EQ(set->addMask(arm.weights()).value(), 1u);
    EXPECT_EQ(set->addMask(arm.inverted().weights()).value(), 2u);
    EXPECT_EQ(set->addMask(JointMask::joints(*set, {"arm", "hand"}).value().weights()).value(), 1u);
    EXPECT_EQ(set->masks().count(), 2u);
    EXPECT_EQ(set->masks().weights(0), nullptr);
    EXPECT_EQ(set->masks().weights(3), nullptr);
    EXPECT_EQ(set->masks().weights(1)[3], 1.0f);
}

TEST(JointMaskTest, TheSetRefusesMasksOfOthersAndTooMany)
{
    const auto set = makeSet();
    const auto other = AnimationSet::create({Skeleton::create({Joint()}).value(), {}, {}, {}, {}}).value();
    const Result<std::uint32_t> foreign = set->addMask(JointMask(*other).weights());
    ASSERT_FALSE(foreign);
    EXPECT_EQ(foreign.error().message, "a mask of 1 tracks for a set of 9");

    JointMask mask(*set);
    for (std::size_t i = 0; i < MaskTable::maxMasks; ++i)
    {
        mask.setJoint(0, static_cast<float>(i) / static_cast<float>(MaskTable::maxMasks));
        EXPECT_TRUE(set->addMask(mask.weights()));
    }
    mask.setJoint(1, 1.0f);
    const Result<std::uint32_t> tooMany = set->addMask(mask.weights());
    ASSERT_FALSE(tooMany);
    EXPECT_EQ(tooMany.error().message, "the set has " + std::to_string(MaskTable::maxMasks) + " masks already");
}

// A soft edge that moves in every frame.
TEST(JointMaskTest, AMaskMayChangeInEveryFrame)
{
    const auto set = makeGaitSet();
    const std::size_t spine = static_cast<std::size_t>(set->skeleton().findJoint("spine1"));
    AnimationController controller(set);
    AnimationLayer& layer = controller.layer(1);
    ASSERT_TRUE(layer.play("Run"));
    layer.seek(0.2);
    std::vector<JointTransform> run, found;
    Pose::mix(*set, PoseInstruction{1, {set->sampleAt(set->findClip("Run"), 0.2)}}, run);
    JointMask mask(*set);
    PoseInstruction kept; // of a frame that is still drawn: its mask lives on
    std::shared_ptr<const SetMask> keptMask;
    for (int change = 0; change < 100000; ++change)
    {
        const float weight = static_cast<float>(change % 997) / 997.0f;
        mask.setJoint(spine, weight);
        ASSERT_TRUE(layer.setMask(mask)) << "change " << change;
        if (change == 500)
        {
            kept = controller.instruction();
            keptMask = set->masks().find(layer.mask());
        }
        if (change % 100 != 0) continue;
        ASSERT_LE(set->masks().count(), 3u);
        Pose::mix(*set, controller.instruction(), found);
        const glm::vec4 rest = set->restPose()[spine].rotation, full = run[spine].rotation;
        const glm::vec4 wanted =
            glm::normalize(rest * (1.0f - weight) + full * (glm::dot(rest, full) < 0 ? -weight : weight));
        for (int part = 0; part < 4; ++part)
            ASSERT_NEAR(found[spine].rotation[part], wanted[part], 1e-5f) << "change " << change;
    }
    Pose::mix(*set, kept, found);
    EXPECT_EQ(keptMask->weights[spine], 500.0f / 997.0f);
    const std::vector<JointTransform> before = found;
    keptMask = nullptr;
    EXPECT_LE(set->masks().count(), 2u);
    controller = AnimationController(set);
    EXPECT_EQ(set->masks().count(), 0u) << "nobody uses one any more";
}

// As the test above, with all layers of many characters, their copies and their snapshots.
TEST(JointMaskTest, MasksLiveAsLongAsTheirUsers)
{
    const auto set = makeGaitSet();
    std::vector<AnimationController> controllers(100, AnimationController(set));
    JointMask mask(*set);
    for (std::size_t c = 0; c < controllers.size(); ++c)
        for (std::size_t layer = 0; layer < maxLayers; ++layer)
        {
            mask.setJoint(0, static_cast<float>(c * maxLayers + layer) / 1000.0f);
            ASSERT_TRUE(controllers[c].layer(layer).setMask(mask));
        }
    EXPECT_EQ(set->masks().count(), 100 * maxLayers);
    const AnimationController copy = controllers[7];
    const LayerSnapshot snapshot = controllers[8].layer(3).snapshot();
    controllers.clear();
    EXPECT_EQ(set->masks().count(), maxLayers);
    for (std::size_t layer = 0; layer < maxLayers; ++layer)
        EXPECT_EQ(set->masks().weights(copy.layer(layer).mask())[0], static_cast<float>(56 + layer) / 1000.0f);
    AnimationController restored(set->withClips(set->clips()).value());
    ASSERT_TRUE(restored.layer(3).restore(snapshot));
    EXPECT_EQ(restored.layer(3).snapshot().mask[0], 67.0f / 1000.0f);
}

TEST(JointMaskTest, TheLastMorphHasAWeightAndOneBeyondHasNot)
{
    const std::vector<MorphWeights> morphs{{"face", 0, std::vector<float>(14)}, {"hand", 0, {0.5f}}};
    const auto set = AnimationSet::create({Skeleton::create({Joint()}).value(), {}, {}, morphs, {}}).value();
    JointMask mask(*set);
    EXPECT_TRUE(mask.setMorph(1, 0.5f));
    EXPECT_FALSE(mask.setMorph(2, 0.5f));
    EXPECT_FALSE(mask.setJoint(1, 0.5f));
    EXPECT_EQ(mask.weights(), (std::vector<float>{0, 0, 0, 0.5f}));
    EXPECT_TRUE(mask.setMorph(0, 1.0f));
    EXPECT_EQ(mask.inverted().weights(), (std::vector<float>{1, 0, 0, 0.5f}));
}

} // namespace
} // namespace osgGpuAnimation
