// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>

#include "nodes/UpdateVisits.h"
#include "support/NotifyLog.h"
#include "support/TestCrowd.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include <osg/Geometry>
#include <osg/Group>
#include <osgUtil/Optimizer>

namespace osgGpuAnimation
{

namespace
{

/// The places in the world of the nodes "sword", along every path, as OSG's visitors compute them.
class Swords : public osg::NodeVisitor
{
public:
    Swords() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Node& node) override
    {
        if (node.getName() == "sword") places.push_back(_toWorld.getTrans());
        traverse(node);
    }
    void apply(osg::Transform& transform) override
    {
        const osg::Matrix above = _toWorld;
        transform.computeLocalToWorldMatrix(_toWorld, this);
        traverse(transform);
        _toWorld = above;
    }
    std::vector<osg::Vec3d> places;

private:
    osg::Matrix _toWorld;
};

osg::Vec3d swordIn(osg::Node& scene)
{
    Swords swords;
    scene.accept(swords);
    return swords.places.size() == 1 ? swords.places[0] : osg::Vec3d(1e30, 0, 0);
}

void updateAt(osg::Node& scene, double time)
{
    UpdateVisits().visit(scene, time);
}

void addSword(JointAttachment& attachment)
{
    osg::ref_ptr<osg::Geometry> sword = osg::createTexturedQuadGeometry({}, {1, 0, 0}, {0, 0, 1});
    sword->setName("sword");
    attachment.addChild(sword);
}

/// A character that carries a sword.
osg::ref_ptr<AnimatedCharacter> characterWith(JointAttachment* attachment)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    addSword(*attachment);
    character->addChild(attachment);
    return character;
}

/// Holds the end of the clip: a quarter about +Y in "turn".
void holdEndOf(AnimationController& controller, const char* clip)
{
    ASSERT_TRUE(controller.play(clip));
    controller.setLoopMode(LoopMode::Once);
    controller.seek(2.0);
}

::testing::AssertionResult isNear(const osg::Vec3d& found, const osg::Vec3d& wanted)
{
    if ((found - wanted).length() < 1e-6) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << found.x() << " " << found.y() << " " << found.z();
}

} // namespace

TEST(JointAttachmentTest, followsAJointByNameOrNumber)
{
    for (JointAttachment* attachment : {new JointAttachment("tip"), new JointAttachment(1)})
    {
        osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment);
        character->setMatrix(osg::Matrix::translate(0, 0, 5));
        updateAt(*character, 1.0);
        updateAt(*character, 1.5);
        EXPECT_TRUE(isNear(swordIn(*character), {0.5, 0, 5}));
        EXPECT_TRUE(isNear(attachment->getMatrix().getTrans(), {0.5, 0, 0})) << "for bounds, which know no path";
        holdEndOf(character->getController(), "shift");
        EXPECT_TRUE(isNear(swordIn(*character), {2, 0, 5})) << "at once, as the palette is drawn";
        attachment->setJoint("side");
        EXPECT_TRUE(isNear(swordIn(*character), {4, 0, 5})) << "another joint at once";
        updateAt(*character, 1.5);
        EXPECT_TRUE(isNear(attachment->getMatrix().getTrans(), {4, 0, 0}));
        attachment->setJoint(0);
        updateAt(*character, 1.5);
        EXPECT_TRUE(isNear(attachment->getMatrix().getTrans(), {2, 0, 0}));
    }
}

TEST(JointAttachmentTest, anOffsetIsInTheJointsSpaceAndTurnsWithIt)
{
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("tip");
    attachment->setOffset(osg::Matrix::translate(1, 0, 0));
    const osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment);
    holdEndOf(character->getController(), "turn");
    EXPECT_TRUE(isNear(swordIn(*character), {0, 0, -1}));
    const osg::ref_ptr<osg::Node> clone = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_TRUE(isNear(swordIn(*clone), {0, 0, -1}));
    EXPECT_TRUE(isNear(osg::Vec3d(1, 0, 0) * character->jointToModel("tip").value(), {0, 0, -1}));
    EXPECT_EQ(character->jointToModel(1).value(), character->jointToModel("tip").value());
    EXPECT_EQ(character->jointToModel("wing").error().message,
              "there is no joint \"wing\"; the joints are \"base\", \"tip\", \"side\"");
    for (std::size_t outside : {std::size_t(3), ~std::size_t(0)})
        EXPECT_FALSE(character->jointToModel(outside)) << "there are three";
    osg::NodeVisitor along;
    along.pushOntoNodePath(character);
    const osg::Matrix above = osg::Matrix::rotate(0.7, 1, 0, 0) * osg::Matrix::translate(1, 2, 3);
    osg::Matrix toWorld = above, toLocal = osg::Matrix::inverse(above);
    ASSERT_TRUE(attachment->computeLocalToWorldMatrix(toWorld, &along));
    ASSERT_TRUE(attachment->computeWorldToLocalMatrix(toLocal, &along));
    EXPECT_TRUE(isNear(osg::Vec3d(5, -4, 3) * toWorld * toLocal, {5, -4, 3}));
}

TEST(JointAttachmentTest, whatIsDetachedStaysWhereItIs)
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
    const osg::Vec3d before = swordIn(*root);
    EXPECT_TRUE(isNear(before, {5, 5, 2})) << "2 for the joint and 0.5 for the clip, 1 for the offset; times 2";
    const Result<osg::ref_ptr<osg::MatrixTransform>> lost = attachment->detach(*room);
    ASSERT_TRUE(lost) << lost.error().message;
    EXPECT_EQ(attachment->getNumParents(), 0u);
    EXPECT_EQ(lost.value()->getParent(0), room);
    EXPECT_EQ(lost.value()->getName(), "scabbard");
    character->getController().seek(1.5);
    EXPECT_TRUE(isNear(swordIn(*root), before));
    EXPECT_EQ(attachment->detach(*room).error().message,
              "the attachment of joint \"side\" has 0 parents and 1 paths from the root: expected one of each");
    character->addChild(attachment);
    room->addChild(character);
    EXPECT_FALSE(attachment->detach(*room)) << "two paths";
}

TEST(JointAttachmentTest, followsAnInstanceOfACrowd)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = makeCrowd(*makeTestCharacter(), {osg::Matrix::translate(100, 0, 0)});
    const auto second = crowd->add(osg::Matrix::translate(100, 7, 0), playing("shift")).value();
    const osg::ref_ptr<JointAttachment> attachment = new JointAttachment("side");
    addSword(*attachment);
    crowd->addChild(attachment);
    updateAt(*crowd, 1.0);
    EXPECT_TRUE(isNear(swordIn(*crowd), {100, 0, 0})) << "no instance yet: at the crowd's origin";
    attachment->setInstance(second);
    updateAt(*crowd, 1.5);
    EXPECT_TRUE(isNear(crowd->jointToCrowd(second, "side").value().getTrans(), {102.5, 7, 0}));
    EXPECT_TRUE(isNear(swordIn(*crowd), {102.5, 7, 0}));
    EXPECT_TRUE(isNear(attachment->getMatrix().getTrans(), {2.5, 7, 0})) << "relative to the crowd's origin";
    ASSERT_TRUE(crowd->setPlacement(second, osg::Matrix::translate(0, 9, 0)));
    EXPECT_TRUE(isNear(swordIn(*crowd), {2.5, 9, 0}));
    EXPECT_EQ(osg::ref_ptr<JointAttachment>(osg::clone(attachment.get()))->getInstance(), second);
    attachment->setJoint("wing");
    EXPECT_TRUE(isNear(swordIn(*crowd), {0, 9, 0})) << "no such joint: at the placement";
    attachment->setJoint("side");
    updateAt(*crowd, 1.5);
    crowd->remove(second);
    updateAt(*crowd, 1.7);
    EXPECT_TRUE(isNear(swordIn(*crowd), {2.5, 9, 0})) << "the instance is gone, the sword stays";
    EXPECT_FALSE(crowd->jointToCrowd(second, "side"));
    EXPECT_FALSE(crowd->jointToCrowd(second, 99));
}

TEST(JointAttachmentTest, boundsHoldWhatIsAttachedAndThoseOfClipsLeaveOutARider)
{
    const osg::ref_ptr<AnimatedCharacter> rider = makeTestCharacter(), horse = makeTestCharacter();
    auto& mesh = dynamic_cast<osg::Geometry&>(*rider->getChild(0));
    for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*mesh.getVertexArray()))
        vertex *= 100.0f;
    const osg::BoundingBox alone = horse->getClipBounds(0);
    const osg::ref_ptr<JointAttachment> seat = new JointAttachment("tip");
    seat->addChild(rider);
    seat->addChild(osg::createTexturedQuadGeometry({}, {0, 50, 0}, {0, 0, 1}));
    horse->addChild(seat);
    horse->computeClipBounds();
    EXPECT_EQ(horse->getClipBounds(0), alone);
    updateAt(*horse, 0.0);
    const osg::BoundingSphere& bound = horse->getBound();
    EXPECT_LE((osg::Vec3d(bound.center()) - osg::Vec3d(0, 50, 1)).length(), bound.radius() + 1e-4);
}

TEST(JointAttachmentTest, clonesCarryTheirOwnAlsoAfterTheOptimizer)
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
        osgUtil::Optimizer().optimize(scene, osgUtil::Optimizer::DEFAULT_OPTIMIZATIONS);
        updateAt(*scene, 1.0);
        Swords swords;
        scene->accept(swords);
        ASSERT_EQ(swords.places.size(), 2u);
        EXPECT_TRUE(isNear(swords.places[0], {0.25, 0, 0}));
        EXPECT_TRUE(isNear(swords.places[1], {1.75, 0, 0}));
    }
}

TEST(JointAttachmentTest, withoutItsJointOrACharacterItStaysAtTheOriginAndWarnsOnce)
{
    osg::ref_ptr<JointAttachment> attachment = new JointAttachment("wing");
    osg::ref_ptr<AnimatedCharacter> character = characterWith(attachment), other = makeTestCharacter();
    ASSERT_TRUE(other->setAnimationSet(other->getAnimationSet().withClips(other->getAnimationSet().clips()).value()));
    other->addChild(attachment); // shared by characters of different sets
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(character);
    scene->addChild(other);
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
    const auto warnings = [&]
    {
        int count = 0;
        const std::string start = "an attachment follows";
        for (std::size_t at = log->text.find(start); at != std::string::npos; at = log->text.find(start, at + 1))
            ++count;
        return count;
    };
    osg::setNotifyHandler(log);
    for (int frame = 0; frame < 5; ++frame)
        updateAt(*scene, 0.1 * frame);
    EXPECT_EQ(warnings(), 1);
    EXPECT_NE(log->text.find("\"side\""), std::string::npos) << "it lists the joints: " << log->text;
    attachment->setJoint("fin");
    updateAt(*scene, 1.0);
    EXPECT_EQ(warnings(), 2) << "another joint";
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
    EXPECT_TRUE(isNear(swordIn(*character), {0, 0, 0}));
    osg::Matrix matrix;
    osg::NodeVisitor visitor;
    EXPECT_TRUE(osg::ref_ptr<JointAttachment>(new JointAttachment(7))->computeLocalToWorldMatrix(matrix, &visitor));
    EXPECT_TRUE(matrix.isIdentity());
}

TEST(JointAttachmentTest, aNewSetChangesNothingElse)
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
    const RootMotion motion = AnimationController(controller).takeRootMotion();
    ASSERT_FALSE(motion.isNone());

    ASSERT_TRUE(character->setAnimationSet(moving->withClips(moving->clips()).value()));
    EXPECT_EQ(controller.layer(0).weight(), 0.5f);
    EXPECT_EQ(controller.layer(0).settings().blendPriority, 3);
    EXPECT_NE(ControllerDetail::maskNumber(controller.layer(0)), 0u);
    ASSERT_EQ(controller.layerCount(), 2u);
    EXPECT_EQ(controller.layer(1).state(), PlayState::Ended);
    EXPECT_EQ(controller.layer(1).playback().clip(), 1);
    EXPECT_EQ(AnimationController(controller).takeRootMotion().translation, motion.translation);
    int finished = 0;
    controller.setEventCallback([&](const AnimationEvent& event)
                                { finished += event.type == AnimationEvent::Type::Finished ? 1 : 0; });
    controller.advance(0.1);
    EXPECT_EQ(finished, 0) << "told before";

    controller.layer(1).setSpeed(2.0);
    ASSERT_TRUE(character->setAnimationSet(moving->withClips({moving->clips()[0]}).value()));
    EXPECT_TRUE(controller.isPlaying());
    EXPECT_EQ(controller.layer(1).state(), PlayState::Stopped) << "its clip is not there any more";
    EXPECT_EQ(controller.layer(1).settings().speed, 2.0);
    for (const auto& other : {AnimationSet::create({Skeleton::create({}).value(), {}, {}, {}, {}}).value(),
                              std::shared_ptr<const AnimationSet>()})
        EXPECT_FALSE(character->setAnimationSet(other)) << "of another palette";
    EXPECT_EQ(controller.clip(), 0);
}

TEST(JointAttachmentTest, aCharacterGoesByItsRootMotion)
{
    osg::ref_ptr<AnimatedCharacter> character = characterWith(new JointAttachment("tip"));
    ASSERT_TRUE(character->setAnimationSet(withRootMotion(character->getAnimationSet(), "base").value()));
    EXPECT_EQ(character->getController().clip(), 0) << "plays on";
    character->addUpdateCallback(new RootMotionCallback);
    character->setMatrix(osg::Matrix::rotate(osg::PI_2, osg::Vec3d(0, 0, 1)) * osg::Matrix::translate(0, 0, 3));
    for (int i = 0; i <= 76; ++i)
        updateAt(*character, 0.1 * std::min(i, 75)); // the last two at the same time: it goes once
    // One metre per second along its own x, which is the world's y, through several loops of two seconds.
    EXPECT_TRUE(isNear(character->getMatrix().getTrans(), {0, 7.5, 3}));
    EXPECT_TRUE(isNear(swordIn(*character), {0, 7.5, 3})) << "the clip itself stays where it is";
}

} // namespace osgGpuAnimation
