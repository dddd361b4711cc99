// SPDX-License-Identifier: MIT
#include "nodes/UpdateVisits.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SpringBones.h>

#include <osg/MatrixTransform>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

// Spring chains of unusual characters: scaled and animated joints, several chains, colliders on chains, long frames.

namespace osgGpuAnimation
{

namespace
{

Joint springJoint(const char* name, int parent, const glm::vec3& place, const glm::vec3& scale = glm::vec3(1.0f))
{
    Joint joint{name, parent, {}, -1};
    joint.rest.translation = glm::vec4(place, 0.0f);
    joint.rest.scale = glm::vec4(scale, 0.0f);
    return joint;
}

SpringChain heavyChain(std::initializer_list<const char*> names)
{
    SpringChain chain;
    for (const char* name : names)
        chain.joints.push_back({name, 0.0f, 1.0f, 10.0f});
    return chain;
}

/// A character in the axes of its file, with spring chains.
struct Hanging
{
    explicit Hanging(const std::vector<Joint>& joints, std::vector<SpringChain> chains,
                     std::vector<SpringCollider> colliders = {}, const char* turned = nullptr)
        : character(new AnimatedCharacter(setOf(joints, turned))), springs(new SpringBones)
    {
        EXPECT_TRUE(springs->setChains(character->getAnimationSet(), std::move(chains), std::move(colliders)));
        character->addUpdateCallback(springs);
        place->addChild(character);
        if (turned)
        {
            EXPECT_TRUE(character->getController().play("turn"));
        }
    }

    /// turned: a joint that the clip "turn" holds at an angle; null: no clip.
    static std::shared_ptr<const AnimationSet> setOf(const std::vector<Joint>& joints, const char* turned)
    {
        AnimationParts parts{Skeleton::create(joints).value(), {}, {}, {}, {}};
        if (!turned) return AnimationSet::create(std::move(parts)).value();
        ClipBuilder builder(parts.skeleton, {});
        EXPECT_TRUE(builder.add({Channel::Path::Rotation,
                                 Channel::Interpolation::Linear,
                                 parts.skeleton.findJoint(turned),
                                 {0, 1},
                                 {0, 0.6, 0, 0.8, 0, 0.6, 0, 0.8}}));
        parts.clips.push_back(builder.build("turn"));
        return AnimationSet::create(std::move(parts)).value();
    }

    void updateTo(double time) { updates.visit(*place, time); }
    void settle(double seconds = 3.0)
    {
        for (int i = 0; i <= 60.0 * seconds; ++i)
            updateTo(i / 60.0);
    }

    osg::Vec3d joint(const std::string& name) const
    {
        return character->jointToModel(name).value().getTrans() * place->getMatrix();
    }
    osg::Vec3d direction(const std::string& from, const std::string& to) const
    {
        osg::Vec3d way = joint(to) - joint(from);
        way.normalize();
        return way;
    }

    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    osg::ref_ptr<AnimatedCharacter> character;
    osg::ref_ptr<SpringBones> springs;
    UpdateVisits updates;
};

/// A horizontal rod of four joints.
std::vector<Joint> rod()
{
    return {springJoint("a", -1, {0, 0, 1}), springJoint("b", 0, {0.3f, 0, 0}), springJoint("c", 1, {0.3f, 0, 0}),
            springJoint("d", 2, {0.3f, 0, 0})};
}

} // namespace

TEST(SpringBonesEdgesTest, withoutStiffnessScaledJointsHangStraightDown)
{
    Hanging hanging({springJoint("root", -1, {1, 2, 3}, {1, 1, 2}), springJoint("a", 0, {0, 0, 1}, {2, 1, 0.5f}),
                     springJoint("b", 1, {0.3f, 0.2f, 0.1f}, {1, 3, 1}), springJoint("c", 2, {0.1f, 0.3f, 0.2f})},
                    {heavyChain({"a", "b", "c"})});
    hanging.place->setMatrix(osg::Matrixd::rotate(0.7, osg::Vec3d(1, 1, 0)) * osg::Matrixd::translate(5, 0, 0));
    hanging.settle();
    for (const auto& [from, to] : {std::pair("a", "b"), std::pair("b", "c")})
        EXPECT_LT((hanging.direction(from, to) - osg::Vec3d(0, 0, -1)).length(), 1e-3) << from;
}

TEST(SpringBonesEdgesTest, jointsReturnToTheRestOfTheSkeletonWhateverTheClipDoes)
{
    SpringChain chain{{{"b", 5.0f, 0.5f}, {"c", 5.0f, 0.5f}, {"d"}}, {}};
    Hanging animated(rod(), {chain}, {}, "b");
    animated.settle(1.0);
    EXPECT_LT((animated.direction("b", "c") - osg::Vec3d(1, 0, 0)).length(), 1e-4);
    EXPECT_TRUE(animated.springs->setChains({}));
    animated.updateTo(1.1);
    EXPECT_GT((animated.direction("b", "c") - osg::Vec3d(1, 0, 0)).length(), 0.5) << "the clip";
}

TEST(SpringBonesEdgesTest, chainsMayBeListedInAnyOrder)
{
    const SpringChain upper = heavyChain({"a", "b"}), lower = heavyChain({"c", "d"});
    Hanging one(rod(), {upper, lower}), other(rod(), {lower, upper});
    for (Hanging* each : {&one, &other})
        each->settle(0.2);
    EXPECT_LT((one.joint("d") - other.joint("d")).length(), 1e-6);
    EXPECT_LT(other.direction("a", "b").z(), -0.5);
    EXPECT_LT(other.direction("c", "d").z(), -0.5);
}

TEST(SpringBonesEdgesTest, longFramesOfAMovingCharacterHaveTheSubstepsOfShortOnes)
{
    SpringChain chain{{{"a", 1.0f, 0.1f, 0.5f}, {"b", 1.0f, 0.1f, 0.5f}, {"c", 1.0f, 0.1f, 0.5f}, {"d"}}, {}};
    Hanging often(rod(), {chain}), seldom(rod(), {chain});
    for (int step = 0; step <= 120; ++step)
    {
        const double time = step / 60.0;
        for (Hanging* each : {&often, &seldom})
        {
            if (each == &seldom && step % 6 != 0) continue;
            each->place->setMatrix(osg::Matrixd::scale(2, 2, 2) *
                                   osg::Matrixd::rotate(1.5 * time, osg::Vec3d(0, 0.6, 0.8)) *
                                   osg::Matrixd::translate(3.0 * time, 1.0, -time));
            each->updateTo(time);
        }
        if (step % 6 != 0) continue;
        ASSERT_LT((often.joint("d") - seldom.joint("d")).length(), 1e-4) << time;
    }
}

TEST(SpringBonesEdgesTest, collidersOnAChainSwingWithIt)
{
    // The pushed chain comes before the one that carries the ball.
    const std::vector<Joint> joints = {springJoint("root", -1, {0, 0, 0}), springJoint("b", 0, {0.1f, 0, 0}),
                                       springJoint("tip", 1, {0, 0, -1}), springJoint("a", 0, {0, 0, 0}),
                                       springJoint("ball", 3, {1, 0, 0})};
    SpringChain pushed = heavyChain({"b", "tip"});
    pushed.joints[0].radius = 0.1f;
    pushed.colliders = {0};
    Hanging hanging(joints, {pushed, heavyChain({"a", "ball"})}, {{"ball", {}, std::nullopt, 0.3f}});
    hanging.settle();
    ASSERT_LT(hanging.direction("a", "ball").z(), -0.99);
    EXPECT_NEAR((hanging.joint("tip") - hanging.joint("ball")).length(), 0.4, 0.02);
}

TEST(SpringBonesEdgesTest, theLayerIsTheOneThatWasSelected)
{
    const std::pair<std::size_t, std::size_t> layers[] = {{2, 3}, {maxLayers - 1, maxLayers}, {99, maxLayers}};
    for (const auto& [layer, count] : layers)
    {
        Hanging hanging(rod(), {heavyChain({"a", "b"})});
        hanging.springs->setLayer(layer);
        hanging.settle(0.1);
        EXPECT_EQ(hanging.character->getController().layerCount(), count);
        EXPECT_EQ(hanging.springs->getLayer(), count - 1);
        EXPECT_LT(hanging.direction("a", "b").z(), -0.1);
    }
}

TEST(SpringBonesEdgesTest, chainsFadeOutAndInWithinAQuarterSecond)
{
    Hanging hanging(rod(), {heavyChain({"a", "b"})});
    hanging.settle(1.0);
    AnimationLayer& layer = hanging.character->getController().layer(maxLayers - 1);
    double time = 1.0;
    for (const bool isNear : {false, true})
    {
        hanging.springs->setMaxDistance(isNear ? std::numeric_limits<double>::infinity() : 1.0); // nobody sees it
        hanging.updateTo(time += 1.0 / 60.0);
        hanging.updateTo(time += 0.1);
        EXPECT_NEAR(layer.weight(), isNear ? 0.4f : 0.6f, 0.01f);
        hanging.updateTo(time += 0.2);
        EXPECT_EQ(layer.weight(), isNear ? 1.0f : 0.0f);
    }
}

TEST(SpringBonesEdgesTest, valuesAtTheEndsOfTheirRangesAreTaken)
{
    const auto set = Hanging::setOf({springJoint("a", -1, {}), springJoint("b", 0, {1, 0, 0}),
                                     springJoint("same place", 1, {}), springJoint("c", 1, {0, 1, 0})},
                                    nullptr);
    const osg::ref_ptr<SpringBones> springs = new SpringBones;
    const SpringJoint taken[] = {{"a", 0.0f, 0.0f}, {"a", 1e6f, 1.0f, -9.0f}};
    for (const SpringJoint& joint : taken)
        EXPECT_TRUE(springs->setChains(*set, {{{joint, {"b"}}, {0}}}, {{"b", {}, std::nullopt, 0.0f}}));
    const auto refused = [&](std::vector<SpringChain> chains, const char* message)
    {
        const Result<void> result = springs->setChains(*set, std::move(chains));
        ASSERT_FALSE(result) << message;
        EXPECT_NE(result.error().message.find(message), std::string::npos) << result.error().message;
        EXPECT_EQ(springs->getChains().size(), 1u);
    };
    refused({{{{"b"}, {"same place"}}, {}}}, "joint \"same place\": it has the place of the joint before it");
    refused({{{{"a"}, {"b"}}, {}}, {{{"b"}, {"c"}}, {}}}, "chain 1, joint \"b\": it is in two chains");
    refused({{{{"a", 1.0f, -0.1f}, {"b"}}, {}}}, "its drag is -0.100000, not in [0, 1]");
    refused({{{{"a", HUGE_VALF}, {"b"}}, {}}}, "its stiffness is inf, not in [0, infinity)");
    refused({{{{"a", 1.0f, 0.5f, std::nanf("")}, {"b"}}, {}}}, "its gravity is nan, not finite");
    SpringJoint joint{"a"};
    joint.gravityDirection = {0, 0.5f, 0};
    refused({{{joint, {"b"}}, {}}}, "its gravity's direction has length 0.500000, not 1");
    joint = {"a"};
    joint.radius = -1.0f;
    refused({{{joint, {"b"}}, {}}}, "its radius is -1.000000, not in [0, infinity)");
}

TEST(SpringBonesEdgesTest, copiesHaveAllSettings)
{
    Hanging hanging(rod(), {heavyChain({"a", "b"}), heavyChain({"c", "d"})}, {{"a", {1, 2, 3}, std::nullopt, 0.5f}});
    hanging.springs->setLayer(5);
    hanging.springs->setMaxDistance(7.0);
    const osg::ref_ptr<SpringBones> copy = osg::clone(hanging.springs.get());
    EXPECT_EQ(copy->getChains().size(), 2u);
    ASSERT_EQ(copy->getColliders().size(), 1u);
    EXPECT_EQ(copy->getColliders()[0].center, osg::Vec3(1, 2, 3));
    EXPECT_EQ(copy->getLayer(), 5u);
    EXPECT_EQ(copy->getMaxDistance(), 7.0);
}

} // namespace osgGpuAnimation
