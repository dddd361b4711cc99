// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"

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
    // The base moves up to 2 along x and may rotate as far as in either clip.
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
