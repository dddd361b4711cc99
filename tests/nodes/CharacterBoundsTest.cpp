// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"

#include <osgGpuAnimation/animation/ClipBuilder.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

namespace
{

TEST(CharacterBoundsTest, FollowWhatLayersAndCrossfadesPlay)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    AnimationController& controller = character->getController();
    const auto* square = dynamic_cast<const SkinnedGeometry*>(character->getChild(0));
    character->update(0.0);
    EXPECT_NEAR(character->getCurrentBounds().xMax(), 3.0f, 1e-3) << "shift alone: its own box";
    EXPECT_NEAR(character->getCurrentBounds().zMin(), 0.0f, 1e-3);

    ASSERT_TRUE(controller.crossfade("turn", 1.0));
    character->update(0.5);
    // The base goes up to 2 along x and may be turned as far as the clips do.
    const osg::BoundingBox mixed = character->getCurrentBounds();
    EXPECT_LE(mixed.zMin(), -1.0f);
    EXPECT_GE(mixed.xMax(), 3.0f);
    EXPECT_GE(character->getBound().radius(), 0.5f * (mixed.xMax() - mixed.xMin()));
    EXPECT_LE(square->getBoundingBox().zMin(), mixed.zMin()) << "the mesh would be culled by itself";

    character->update(3.0);
    character->update(3.1);
    EXPECT_EQ(character->getCurrentBounds().xMax(), character->getClipBounds(1).xMax()) << "turn alone";

    AnimationLayer& added = controller.layer(1);
    added.setMode(AnimationLayer::Mode::Additive);
    ASSERT_TRUE(added.play("shift"));
    character->update(3.2);
    EXPECT_GE(character->getCurrentBounds().xMax(), 3.0f) << "shift is added to the turned square";
    EXPECT_GE(character->getBound().center().x() + character->getBound().radius(), 3.0f);
    EXPECT_GE(square->getBoundingBox().xMax(), character->getCurrentBounds().xMax());
}

/// A square whose only morph target, of weight 0.25 at rest, lifts it by one unit. "rise" takes the weight from 0 to 1
/// in a second, "fall" back.
osg::ref_ptr<AnimatedCharacter> makeMorphedCharacter()
{
    AnimationParts parts{Skeleton::create({Joint()}).value(), {}, {0}, {{"lift", -1, {0.25f}}}, {}};
    for (const double first : {0.0, 1.0})
    {
        ClipBuilder builder(parts.skeleton, parts.morphs);
        EXPECT_TRUE(
            builder.add({Channel::Path::Weights, Channel::Interpolation::Linear, 0, {0, 1}, {first, 1.0 - first}}));
        parts.clips.push_back(builder.build(first == 0.0 ? "rise" : "fall"));
    }
    const auto set = AnimationSet::create(std::move(parts)).value();
    osg::ref_ptr<SkinnedGeometry> square = makeTestSquare(1);
    square->setRigidEntry(static_cast<unsigned short>(set->entryOfRigidJoint(0)));
    osg::ref_ptr<osg::Vec3Array> lifted = new osg::Vec3Array(4);
    std::fill(lifted->begin(), lifted->end(), osg::Vec3(0, 0, 1));
    square->setMorphTargets(*set, 0, {{lifted, nullptr, nullptr, nullptr}});
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
    character->addChild(square);
    character->computeClipBounds();
    return character;
}

TEST(CharacterBoundsTest, HoldMorphWeightsThatAdditiveLayersRaiseAndLower)
{
    struct Case
    {
        const char *clip, *added;
        AnimationLayer::Reference reference;
        double weight; ///< at the end
    };
    using Reference = AnimationLayer::Reference;
    const Case cases[] = {{"fall", "fall", Reference::FirstFrame, -1.0},
                          {"fall", "fall", Reference::RestPose, -0.25},
                          {"rise", "rise", Reference::FirstFrame, 2.0},
                          {"rise", "rise", Reference::RestPose, 1.75}};
    for (const Case& c : cases)
    {
        SCOPED_TRACE(testing::Message() << c.clip << " and " << c.added << " to " << c.weight);
        const osg::ref_ptr<AnimatedCharacter> character = makeMorphedCharacter();
        AnimationController& controller = character->getController();
        controller.setLoopMode(LoopMode::Once);
        ASSERT_TRUE(controller.play(c.clip));
        AnimationLayer& added = controller.layer(1);
        added.setMode(AnimationLayer::Mode::Additive, c.reference);
        added.setLoopMode(LoopMode::Once);
        ASSERT_TRUE(added.play(c.added));
        character->update(0.0);
        character->update(1.0);
        std::vector<AffineMatrix> palette;
        Pose::evaluate(character->getAnimationSet(), controller.instruction(), AffineMatrix(), palette);
        std::vector<glm::dvec3> positions;
        const auto& square = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
        square.computePositions(palette, positions);
        ASSERT_EQ(positions.size(), 4u);
        EXPECT_NEAR(positions[0].z, c.weight, 1e-6);
        for (const glm::dvec3& position : positions)
            for (const osg::BoundingBox& box : {character->getCurrentBounds(), square.getBoundingBox()})
                EXPECT_TRUE(box.contains(osg::Vec3(position.x, position.y, position.z))) << position.z;
    }
}

TEST(CharacterBoundsTest, ACloneHasItsOwn)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    osg::ref_ptr<AnimatedCharacter> clone = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
    ASSERT_TRUE(clone->getController().crossfade("turn", 1.0));
    clone->update(0.0);
    character->update(0.0);
    EXPECT_LE(clone->getCurrentBounds().zMin(), -1.0f);
    EXPECT_NEAR(character->getCurrentBounds().zMin(), 0.0f, 1e-3);
}

} // namespace

} // namespace osgGpuAnimation
