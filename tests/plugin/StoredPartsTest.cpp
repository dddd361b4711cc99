// SPDX-License-Identifier: MIT
#include "plugin/StoredArm.h"

#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>
#include <osgGpuAnimation/nodes/SpringBones.h>

#include <limits>
#include <optional>
#include <tuple>

namespace osgGpuAnimation
{

namespace
{

/// What hangs below a character or a crowd, and the callbacks of a character.
class StoredPartsTest : public StoredArmTest
{
};

} // namespace

TEST_F(StoredPartsTest, everythingBelowACharacterComesBack)
{
    osg::ref_ptr<JointAttachment> hand = new JointAttachment("hand");
    hand->addChild(new osg::Group);
    character().addChild(hand);
    character().addChild(new JointAttachment(2));
    auto moving = withRootMotion(character().getAnimationSet(), "arm \"1\" <&{ä", {true, false, false});
    ASSERT_TRUE(moving) << moving.error().message;
    std::vector<Clip> clips = moving.value()->clips();
    clips[0] = clips[0].withMarkers({{0.25, "left foot"}, {0.5, ""}}).value();
    ASSERT_TRUE(character().setAnimationSet(moving.value()->withClips(clips).value()));
    character().addUpdateCallback(new RootMotionCallback);
    dynamic_cast<CharacterKeys&>(*character().getEventCallback()).setFadeSeconds(1.75);
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Node> read = files.throughFile(*scene, format);
        ASSERT_TRUE(read && findCharacter(*read));
        AnimatedCharacter& back = *findCharacter(*read);
        ASSERT_EQ(back.getNumChildren(), character().getNumChildren());
        const auto* byName = dynamic_cast<JointAttachment*>(back.getChild(back.getNumChildren() - 2));
        const auto* byNumber = dynamic_cast<JointAttachment*>(back.getChild(back.getNumChildren() - 1));
        ASSERT_TRUE(byName && byNumber);
        EXPECT_EQ(byName->getJointName(), "hand");
        EXPECT_EQ(byName->getNumChildren(), 1u);
        EXPECT_EQ(byNumber->getJoint(), 2);
        EXPECT_TRUE(dynamic_cast<RootMotionCallback*>(back.getUpdateCallback()));
        const auto* keys = dynamic_cast<const CharacterKeys*>(back.getEventCallback());
        ASSERT_TRUE(keys);
        EXPECT_EQ(keys->getFadeSeconds(), 1.75);
        const Clip& clip = back.getAnimationSet().clips()[0];
        ASSERT_EQ(clip.markers().size(), 2u);
        EXPECT_EQ(clip.markers()[0].name, "left foot");
        EXPECT_EQ(clip.markers()[0].time, 0.25);
        ASSERT_TRUE(clip.rootMotion());
        EXPECT_EQ(clip.rootMotion()->keys.size(), clip.keyframeCount());
        EXPECT_EQ(clip.rootMotionAt(0.5).translation, clips[0].rootMotionAt(0.5).translation);
        EXPECT_EQ(back.getCurrentBounds()._max, character().getCurrentBounds()._max);
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredPartsTest, FeetOnTheGround)
{
    const osg::ref_ptr<osg::Group> ground = new osg::Group;
    ground->setName("hill \"1\" <&{ä");
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    ASSERT_TRUE(feet->setLegs({{"left", "toes", 0.1, "down", "up"}, {"right \"leg\""}}));
    feet->setTraversalMask(0x80000001u);
    EXPECT_TRUE(feet->setReach(0.3) && feet->setMaxTilt(0.2) && feet->setLockDistance(0.0) && feet->setWeight(0.5));
    character().addUpdateCallback(feet);
    for (const bool isNear : {false, true})
        for (const char* format : storedFormats)
        {
            SCOPED_TRACE(format);
            EXPECT_TRUE(!isNear || feet->setMaxDistance(20.25));
            const osg::ref_ptr<osg::Node> read = files.throughFile(*scene, format);
            ASSERT_TRUE(read && findCharacter(*read));
            auto* back = dynamic_cast<GroundFeet*>(findCharacter(*read)->getUpdateCallback());
            ASSERT_TRUE(back);
            EXPECT_EQ(back->getGroundName(), ground->getName());
            EXPECT_EQ(back->getTraversalMask(), 0x80000001u);
            EXPECT_EQ(back->getReach(), 0.3);
            EXPECT_EQ(back->getMaxTilt(), 0.2);
            EXPECT_EQ(back->getLockDistance(), 0.0);
            EXPECT_EQ(back->getWeight(), 0.5);
            EXPECT_EQ(back->getMaxDistance(), feet->getMaxDistance());
            ASSERT_EQ(back->getLegs().size(), 2u);
            EXPECT_EQ(back->getLegs()[0].toe, "toes");
            EXPECT_EQ(back->getLegs()[0].sole, 0.1);
            EXPECT_EQ(back->getLegs()[0].touchMarker, "down");
            EXPECT_EQ(back->getLegs()[0].leaveMarker, "up");
            EXPECT_EQ(back->getLegs()[1].constraint, "right \"leg\"");
        }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredPartsTest, attachmentsKeepTheirOffsetAndInstance)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character());
    const AnimationController controller(crowd->getSharedAnimationSet());
    ASSERT_TRUE(crowd->remove(crowd->add(osg::Matrixd(), controller).value()));
    ASSERT_TRUE(crowd->add(osg::Matrixd(), controller));
    const osg::ref_ptr<JointAttachment> hand = new JointAttachment("hand");
    hand->setOffset(osg::Matrixd::rotate(1, 0, 0, 1) * osg::Matrixd::translate(0.1, 2, 3));
    hand->setInstance(crowd->add(osg::Matrixd::translate(7, 0, 0), controller).value());
    crowd->addChild(hand);
    for (const char* format : storedFormats)
    {
        const osg::ref_ptr<osg::Node> read = files.throughFile(*crowd, format);
        auto* back = dynamic_cast<AnimatedCrowd*>(read.get());
        ASSERT_TRUE(back);
        const auto* again = dynamic_cast<JointAttachment*>(back->getChild(back->getNumChildren() - 1));
        ASSERT_TRUE(again);
        EXPECT_EQ(again->getJointName(), "hand");
        EXPECT_TRUE(again->getOffset() == hand->getOffset());
        ASSERT_TRUE(again->getInstance());
        EXPECT_EQ(back->getPlacement(*again->getInstance()).getTrans(), osg::Vec3d(7, 0, 0));
    }
    EXPECT_EQ(log->text, "");
}

TEST_F(StoredPartsTest, springsAreKept)
{
    const osg::ref_ptr<SpringBones> springs = new SpringBones;
    SpringChain chain{{{"arm \"1\" <&{ä", 3.0f, 0.25f, 0.5f, osg::Vec3(0, 0.6f, 0.8f), 0.125f}, {"hand"}}, {1, 0}};
    const std::vector<SpringCollider> colliders{{"hand", osg::Vec3(1, 2, 3), std::nullopt, 0.5f},
                                                {"hand", osg::Vec3(), osg::Vec3(4, 5, 6), 0.75f}};
    ASSERT_TRUE(springs->setChains({chain}, colliders));
    springs->setLayer(3);
    character().addUpdateCallback(springs);
    for (const double maxDistance : {std::numeric_limits<double>::infinity(), 12.5})
        for (const char* format : storedFormats)
        {
            SCOPED_TRACE(format);
            springs->setMaxDistance(maxDistance);
            const osg::ref_ptr<osg::Node> read = files.throughFile(*scene, format);
            ASSERT_TRUE(read && findCharacter(*read));
            const auto* back = dynamic_cast<SpringBones*>(findCharacter(*read)->getUpdateCallback());
            ASSERT_TRUE(back);
            EXPECT_EQ(back->getLayer(), 3u);
            EXPECT_EQ(back->getMaxDistance(), maxDistance);
            ASSERT_EQ(back->getChains().size(), 1u);
            const SpringChain& backChain = back->getChains()[0];
            EXPECT_EQ(backChain.colliders, chain.colliders);
            ASSERT_EQ(backChain.joints.size(), 2u);
            for (std::size_t i = 0; i < 2; ++i)
            {
                const SpringJoint &found = backChain.joints[i], &expected = chain.joints[i];
                EXPECT_EQ(found.joint, expected.joint);
                EXPECT_EQ(std::tie(found.stiffness, found.drag, found.gravity, found.gravityDirection, found.radius),
                          std::tie(expected.stiffness, expected.drag, expected.gravity, expected.gravityDirection,
                                   expected.radius));
            }
            ASSERT_EQ(back->getColliders().size(), 2u);
            for (std::size_t i = 0; i < 2; ++i)
            {
                const SpringCollider &found = back->getColliders()[i], &expected = colliders[i];
                EXPECT_EQ(std::tie(found.joint, found.center, found.tail, found.radius),
                          std::tie(expected.joint, expected.center, expected.tail, expected.radius));
            }
        }
}

TEST_F(StoredPartsTest, aCharacterWithoutCallbacksHasNoneAfterwards)
{
    character().setUpdateCallback(nullptr);
    character().setEventCallback(nullptr);
    const osg::ref_ptr<osg::Node> read = files.throughFile(*scene, "osgb");
    ASSERT_TRUE(read && findCharacter(*read));
    EXPECT_FALSE(findCharacter(*read)->getUpdateCallback());
    EXPECT_FALSE(findCharacter(*read)->getEventCallback());
}

} // namespace osgGpuAnimation
