// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>

#include "support/TestCharacter.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Geometry>
#include <osg/Group>
#include <osgUtil/Optimizer>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

namespace
{

class JointAttachmentTest : public ::testing::Test
{
protected:
    void updateAt(osg::Node& scene, double time)
    {
        osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setSimulationTime(time);
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(stamp);
        scene.accept(visitor);
    }

    /// The world positions of a node along every path to it, as OSG's visitors compute them.
    static std::vector<osg::Vec3d> placesOf(osg::Node& scene, const std::string& name)
    {
        class Finder : public osg::NodeVisitor
        {
        public:
            explicit Finder(const std::string& name) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _name(name) {}
            void apply(osg::Node& node) override
            {
                if (node.getName() == _name) places.push_back(place());
                traverse(node);
            }
            std::vector<osg::Vec3d> places;

        private:
            osg::Vec3d place()
            {
                // Each transform sees the path down to itself, as in a cull traversal.
                const osg::NodePath whole = getNodePath();
                osg::Matrix matrix;
                osg::NodeVisitor along;
                for (osg::Node* node : whole)
                {
                    if (osg::Transform* transform = node->asTransform())
                        transform->computeLocalToWorldMatrix(matrix, &along);
                    along.pushOntoNodePath(node);
                }
                return matrix.getTrans();
            }
            std::string _name;
        };
        Finder finder(name);
        scene.accept(finder);
        return finder.places;
    }

    static osg::ref_ptr<AnimatedCharacter> characterWith(JointAttachment* attachment)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        osg::ref_ptr<osg::Geometry> sword = osg::createTexturedQuadGeometry({}, {1, 0, 0}, {0, 0, 1});
        sword->setName("sword");
        attachment->addChild(sword);
        character->addChild(attachment);
        return character;
    }

    static ::testing::AssertionResult isNear(const osg::Vec3d& found, const osg::Vec3d& wanted)
    {
        if ((found - wanted).length() < 1e-6) return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure() << found.x() << " " << found.y() << " " << found.z();
    }
};

TEST_F(JointAttachmentTest, FollowsAJointByNameOrNumber)
{
    for (JointAttachment* attachment : {new JointAttachment("tip"), new JointAttachment(1)})
    {
        osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment);
        character->setMatrix(osg::Matrix::translate(0, 0, 5));
        updateAt(*character, 1.0);
        updateAt(*character, 1.5);
        EXPECT_TRUE(isNear(placesOf(*character, "sword")[0], {0.5, 0, 5}));
        EXPECT_TRUE(isNear(attachment->getMatrix().getTrans(), {0.5, 0, 0})) << "for bounds, which know no path";
        character->getController().seek(2.0);
        character->getController().setLoopMode(LoopMode::Once);
        EXPECT_TRUE(isNear(placesOf(*character, "sword")[0], {2, 0, 5})) << "at once, as the palette is drawn";
    }
}

TEST_F(JointAttachmentTest, AnOffsetIsInTheJointsSpace)
{
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("tip");
    attachment->setOffset(osg::Matrix::translate(1, 0, 0));
    const osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment);
    ASSERT_TRUE(character->getController().play("turn"));
    character->getController().setLoopMode(LoopMode::Once);
    character->getController().seek(1.0);
    EXPECT_TRUE(isNear(placesOf(*character, "sword")[0], {0, 0, -1})) << "a quarter about +Y";
    const osg::ref_ptr<osg::Node> clone = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_TRUE(isNear(placesOf(*clone, "sword")[0], {0, 0, -1}));
}

TEST_F(JointAttachmentTest, WhatIsDetachedStaysWhereItIs)
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> room = new osg::MatrixTransform(osg::Matrix::rotate(0.5, 0, 0, 1));
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("side");
    attachment->setOffset(osg::Matrix::translate(0, 0, 1));
    attachment->setName("scabbard");
    const osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment);
    character->setMatrix(osg::Matrix::scale(2, 2, 2) * osg::Matrix::translate(0, 5, 0));
    root->addChild(room);
    root->addChild(character);
    character->getController().seek(0.5);
    const osg::Vec3d before = placesOf(*root, "sword").at(0);
    const Result<osg::ref_ptr<osg::MatrixTransform>> lost = attachment->detach(*room);
    ASSERT_TRUE(lost) << lost.error().message;
    EXPECT_EQ(attachment->getNumParents(), 0u);
    EXPECT_EQ(lost.value()->getParent(0), room);
    EXPECT_EQ(lost.value()->getName(), "scabbard");
    character->getController().seek(1.5);
    ASSERT_EQ(placesOf(*root, "sword").size(), 1u);
    EXPECT_TRUE(isNear(placesOf(*root, "sword")[0], before));
    EXPECT_TRUE(isNear(before, {5, 5, 2})) << "2 for the joint and 0.5 for the clip, 1 for the offset; times 2";

    const auto again = attachment->detach(*room);
    ASSERT_FALSE(again) << "it has no parent any more";
    EXPECT_EQ(again.error().message, "the attachment of joint \"side\" has 0 parents and 1 paths from the root: "
                                     "expected one of each");
    character->addChild(attachment);
    room->addChild(character);
    EXPECT_FALSE(attachment->detach(*room)) << "two paths";
}

TEST_F(JointAttachmentTest, FollowsAnInstanceOfACrowd)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    AnimationController controller(crowd->getSharedAnimationSet());
    ASSERT_TRUE(controller.play("shift"));
    ASSERT_TRUE(crowd->add(osg::Matrix::translate(100, 0, 0), controller));
    const auto second = crowd->add(osg::Matrix::translate(100, 7, 0), controller).value();
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("side");
    const osg::ref_ptr<osg::Geometry> sword = osg::createTexturedQuadGeometry({}, {1, 0, 0}, {0, 0, 1});
    sword->setName("sword");
    attachment->addChild(sword);
    crowd->addChild(attachment);
    updateAt(*crowd, 1.0);
    EXPECT_TRUE(isNear(placesOf(*crowd, "sword").at(0), {100, 0, 0})) << "no instance yet: at the crowd's origin";
    attachment->setInstance(second);
    updateAt(*crowd, 1.5);
    const Result<osg::Matrixd> joint = crowd->jointToCrowd(second, "side");
    ASSERT_TRUE(joint);
    EXPECT_TRUE(isNear(joint.value().getTrans(), {102.5, 7, 0}));
    EXPECT_TRUE(isNear(placesOf(*crowd, "sword").at(0), {102.5, 7, 0}));
    EXPECT_TRUE(isNear(attachment->getMatrix().getTrans(), {2.5, 7, 0})) << "relative to the crowd's origin";
    ASSERT_TRUE(crowd->setPlacement(second, osg::Matrix::translate(0, 9, 0)));
    EXPECT_TRUE(isNear(placesOf(*crowd, "sword").at(0), {2.5, 9, 0}));
    const osg::ref_ptr<JointAttachment> copy = osg::clone(attachment.get());
    EXPECT_EQ(copy->getInstance(), second);
    attachment->setJoint("wing");
    EXPECT_TRUE(isNear(placesOf(*crowd, "sword").at(0), {0, 9, 0})) << "no such joint: at the placement";
    attachment->setJoint("side");
    updateAt(*crowd, 1.5);
    crowd->remove(second);
    updateAt(*crowd, 1.7);
    EXPECT_TRUE(isNear(placesOf(*crowd, "sword").at(0), {2.5, 9, 0})) << "the instance is gone, the sword stays";
    EXPECT_FALSE(crowd->jointToCrowd(second, "side"));
    EXPECT_FALSE(crowd->jointToCrowd(second, 99));
}

TEST_F(JointAttachmentTest, FollowsANewJointAtOnce)
{
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("tip");
    const osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment);
    updateAt(*character, 1.0);
    EXPECT_TRUE(isNear(placesOf(*character, "sword")[0], {0, 0, 0}));
    attachment->setJoint("side");
    EXPECT_TRUE(isNear(placesOf(*character, "sword")[0], {2, 0, 0}));
    updateAt(*character, 1.0);
    EXPECT_TRUE(isNear(attachment->getMatrix().getTrans(), {2, 0, 0}));
    attachment->setJoint(0);
    updateAt(*character, 1.0);
    EXPECT_TRUE(isNear(attachment->getMatrix().getTrans(), {0, 0, 0}));
}

TEST_F(JointAttachmentTest, TurnsWithItsJoint)
{
    osg::ref_ptr<AnimatedCharacter> character = characterWith(new JointAttachment("tip"));
    ASSERT_TRUE(character->getController().play("turn"));
    character->getController().setLoopMode(LoopMode::Once);
    character->getController().seek(1.0);
    const Result<osg::Matrixd> matrix = character->jointToModel("tip");
    ASSERT_TRUE(matrix);
    EXPECT_TRUE(isNear(osg::Vec3d(1, 0, 0) * matrix.value(), {0, 0, -1})) << "a quarter about +Y";
    const Result<osg::Matrixd> none = character->jointToModel("wing");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message, "there is no joint \"wing\"; the joints are \"base\", \"tip\", \"side\"");
    ASSERT_TRUE(character->jointToModel(1));
    EXPECT_TRUE(character->jointToModel(1).value() == matrix.value());
    for (std::size_t outside : {std::size_t(3), std::size_t(99999), ~std::size_t(0)})
        EXPECT_FALSE(character->jointToModel(outside)) << "there are three";
}

TEST_F(JointAttachmentTest, MatricesOfBothWaysAreInverse)
{
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("side");
    const osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment);
    ASSERT_TRUE(character->getController().play("turn"));
    character->getController().seek(0.5);
    osg::NodeVisitor along;
    along.pushOntoNodePath(character);
    const osg::Matrix above = osg::Matrix::rotate(0.7, 1, 0, 0) * osg::Matrix::translate(1, 2, 3);
    osg::Matrix toWorld = above, toLocal = osg::Matrix::inverse(above);
    ASSERT_TRUE(attachment->computeLocalToWorldMatrix(toWorld, &along));
    ASSERT_TRUE(attachment->computeWorldToLocalMatrix(toLocal, &along));
    EXPECT_TRUE(isNear(osg::Vec3d(5, -4, 3) * toWorld * toLocal, {5, -4, 3}));
    EXPECT_FALSE(isNear(osg::Vec3d(5, -4, 3) * toWorld, osg::Vec3d(5, -4, 3) * above));
}

TEST_F(JointAttachmentTest, BoundsOfTheCharacterHoldWhatIsAttached)
{
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("tip");
    const osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment);
    const osg::ref_ptr<osg::Geometry> lance = osg::createTexturedQuadGeometry({}, {0, 50, 0}, {0, 0, 1});
    attachment->addChild(lance);
    updateAt(*character, 0.0);
    const osg::BoundingSphere& bound = character->getBound();
    EXPECT_LE((osg::Vec3d(bound.center()) - osg::Vec3d(0, 50, 1)).length(), bound.radius() + 1e-4);
}

TEST_F(JointAttachmentTest, BoundsOfClipsLeaveOutTheMeshesOfARider)
{
    const auto boundsWith = [](osg::Node* rider)
    {
        const osg::ref_ptr<JointAttachment> seat = new JointAttachment("tip");
        if (rider) seat->addChild(rider);
        const osg::ref_ptr<AnimatedCharacter> horse = makeTestCharacter();
        horse->addChild(seat);
        horse->computeClipBounds();
        return horse->getClipBounds(0);
    };
    const osg::ref_ptr<AnimatedCharacter> rider = makeTestCharacter();
    auto& mesh = dynamic_cast<osg::Geometry&>(*rider->getChild(0));
    for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*mesh.getVertexArray()))
        vertex *= 100.0f;
    const osg::BoundingBox alone = boundsWith(nullptr), ridden = boundsWith(rider);
    EXPECT_EQ(alone._min, ridden._min);
    EXPECT_EQ(alone._max, ridden._max);
}

TEST_F(JointAttachmentTest, ClonesCarryTheirOwn)
{
    osg::ref_ptr<AnimatedCharacter> one = characterWith(new JointAttachment("tip"));
    for (const auto how : {osg::CopyOp::DEEP_COPY_NODES, osg::CopyOp::SHALLOW_COPY})
    {
        osg::ref_ptr<AnimatedCharacter> other = osg::clone(one.get(), how);
        one->getController().seek(0.25);
        other->getController().seek(1.75);
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(one);
        scene->addChild(other);
        updateAt(*scene, 1.0);
        const std::vector<osg::Vec3d> places = placesOf(*scene, "sword");
        ASSERT_EQ(places.size(), 2u);
        EXPECT_TRUE(isNear(places[0], {0.25, 0, 0}));
        EXPECT_TRUE(isNear(places[1], {1.75, 0, 0}));
    }
}

TEST_F(JointAttachmentTest, SurvivesTheOptimizer)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<AnimatedCharacter> character = characterWith(new JointAttachment("tip"));
    scene->addChild(character);
    osgUtil::Optimizer().optimize(scene, osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS);
    character->getController().seek(1.25);
    updateAt(*scene, 0.0);
    ASSERT_EQ(character->getNumChildren(), 2u);
    EXPECT_TRUE(
        isNear(character->getChild(1)->asTransform()->asMatrixTransform()->getMatrix().getTrans(), {1.25, 0, 0}));
}

TEST_F(JointAttachmentTest, WithoutItsJointOrACharacterItStaysAtTheOrigin)
{
    osg::ref_ptr<AnimatedCharacter> character = characterWith(new JointAttachment("wing"));
    character->getController().seek(1.0);
    updateAt(*character, 0.0);
    EXPECT_TRUE(isNear(placesOf(*character, "sword")[0], {0, 0, 0}));
    osg::ref_ptr<JointAttachment> alone = new JointAttachment(7);
    updateAt(*alone, 0.0);
    osg::Matrix matrix;
    osg::NodeVisitor visitor;
    EXPECT_TRUE(alone->computeLocalToWorldMatrix(matrix, &visitor));
    EXPECT_TRUE(matrix.isIdentity());
}

TEST_F(JointAttachmentTest, SharedByCharactersOfDifferentSetsItWarnsOnce)
{
    class Warnings : public osg::NotifyHandler
    {
    public:
        void notify(osg::NotifySeverity, const char* message) override
        {
            count += std::string(message).find("an attachment follows") != std::string::npos ? 1 : 0;
        }
        int count = 0;
    };
    osg::ref_ptr<JointAttachment> attachment = new JointAttachment("wing");
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(characterWith(attachment));
    osg::ref_ptr<AnimatedCharacter> other = makeTestCharacter();
    ASSERT_TRUE(other->setAnimationSet(other->getAnimationSet().withClips(other->getAnimationSet().clips()).value()));
    other->addChild(attachment);
    scene->addChild(other);
    osg::ref_ptr<Warnings> warnings = new Warnings;
    osg::setNotifyHandler(warnings);
    for (int frame = 0; frame < 5; ++frame)
        updateAt(*scene, 0.1 * frame);
    EXPECT_EQ(warnings->count, 1);
    attachment->setJoint("fin");
    updateAt(*scene, 1.0);
    EXPECT_EQ(warnings->count, 2) << "another joint";
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
}

TEST_F(JointAttachmentTest, ANewSetChangesNothingElse)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const auto moving = withRootMotion(character->getAnimationSet(), "base").value();
    ASSERT_TRUE(character->setAnimationSet(moving));
    AnimationController& controller = character->getController();
    controller.layer(0).setWeight(0.5f);
    controller.layer(0).setBlendPriority(3);
    ASSERT_TRUE(controller.layer(0).setMask(JointMask::subtree(*moving, "base").value()));
    ASSERT_TRUE(controller.layer(1).play("turn"));
    controller.layer(1).setLoopMode(LoopMode::Once);
    controller.advance(100.0);
    ASSERT_EQ(controller.layer(1).state(), PlayState::Ended);
    const RootMotion motion = controller.rootMotion();
    ASSERT_FALSE(motion.isNone());

    ASSERT_TRUE(character->setAnimationSet(moving->withClips(moving->clips()).value()));
    EXPECT_EQ(controller.layer(0).weight(), 0.5f);
    EXPECT_EQ(controller.layer(0).blendPriority(), 3);
    EXPECT_NE(controller.layer(0).mask(), 0u);
    ASSERT_EQ(controller.layerCount(), 2u);
    EXPECT_EQ(controller.layer(1).state(), PlayState::Ended);
    EXPECT_EQ(controller.layer(1).clip(), 1);
    EXPECT_EQ(controller.rootMotion().translation, motion.translation);
    int finished = 0;
    controller.setEventCallback([&](const AnimationEvent& event)
                                { finished += event.type == AnimationEvent::Type::Finished ? 1 : 0; });
    controller.advance(0.1);
    EXPECT_EQ(finished, 0) << "told before";

    controller.layer(1).setSpeed(2.0);
    ASSERT_TRUE(character->setAnimationSet(moving->withClips({moving->clips()[0]}).value()));
    EXPECT_TRUE(controller.isPlaying());
    EXPECT_EQ(controller.layer(1).state(), PlayState::Stopped) << "its clip is not there any more";
    EXPECT_EQ(controller.layer(1).speed(), 2.0);
}

TEST_F(JointAttachmentTest, ACharacterGoesByItsRootMotion)
{
    osg::ref_ptr<AnimatedCharacter> character = characterWith(new JointAttachment("tip"));
    const auto set = withRootMotion(character->getAnimationSet(), "base");
    ASSERT_TRUE(set);
    ASSERT_TRUE(character->setAnimationSet(set.value()));
    EXPECT_EQ(character->getController().clip(), 0) << "plays on";
    character->addUpdateCallback(new RootMotionCallback);
    character->setMatrix(osg::Matrix::rotate(osg::PI_2, osg::Vec3d(0, 0, 1)) * osg::Matrix::translate(0, 0, 3));
    for (int i = 0; i <= 75; ++i)
        updateAt(*character, 0.1 * i);
    // One metre per second along its own x, which is the world's y, through several loops of two seconds.
    EXPECT_TRUE(isNear(character->getMatrix().getTrans(), {0, 7.5, 3}));
    EXPECT_TRUE(isNear(placesOf(*character, "sword")[0], {0, 7.5, 3})) << "the clip itself stays where it is";
    updateAt(*character, 7.5);
    EXPECT_TRUE(isNear(character->getMatrix().getTrans(), {0, 7.5, 3})) << "the same time: once";
}

TEST_F(JointAttachmentTest, ASetOfAnotherPaletteIsRefused)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const auto other = AnimationSet::create({Skeleton::create({}).value(), {}, {}, {}, {}}).value();
    EXPECT_FALSE(character->setAnimationSet(other));
    EXPECT_FALSE(character->setAnimationSet(nullptr));
    EXPECT_EQ(character->getController().clip(), 0);
}

} // namespace

} // namespace osgGpuAnimation
