// SPDX-License-Identifier: MIT
#include "support/TestCrowd.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <osg/ComputeBoundsVisitor>
#include <osg/ShapeDrawable>
#include <osg/Switch>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

namespace
{

TEST(CharacterBoundsTest, followWhatLayersAndCrossfadesPlay)
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

// As SimGear's select does.
TEST(CharacterBoundsTest, aGroupThatAHostPutsAboveAPartChangesNothing)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->update(0.0);
    const float radius = character->getBound().radius();
    const osg::ref_ptr<osg::Node> part = character->getChild(0);
    const osg::ref_ptr<osg::Group> hosts = new osg::Switch;
    character->replaceChild(part, hosts);
    hosts->addChild(part);
    EXPECT_FLOAT_EQ(character->getBound().radius(), radius);
    // What else is there counts.
    hosts->addChild(new osg::MatrixTransform(osg::Matrix::translate(50, 0, 0)));
    hosts->getChild(1)->asGroup()->addChild(new osg::ShapeDrawable(new osg::Sphere));
    EXPECT_GT(character->getBound().radius(), 24.0f);
}

/// A square whose only morph target, of weight 0.25 at rest, lifts its first corner by `lift`, the others less. "rise"
/// takes the weight from 0 to 1 in a second, "fall" back.
osg::ref_ptr<AnimatedCharacter> makeMorphedCharacter(float lift)
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
    for (std::size_t corner = 0; corner < lifted->size(); ++corner)
        (*lifted)[corner].z() = lift * (1.0f - 0.2f * static_cast<float>(corner));
    square->setMorphTargets(*set, 0, {{lifted, nullptr, nullptr, nullptr}});
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
    character->addChild(square);
    character->computeClipBounds();
    return character;
}

/// The vertices of the mesh as the controller poses them.
std::vector<glm::dvec3> positionsOf(const SkinnedGeometry& mesh, const AnimationController& controller)
{
    std::vector<AffineMatrix> palette;
    Pose::evaluate(controller.set(), controller.instruction(), AffineMatrix(), palette);
    std::vector<glm::dvec3> positions;
    mesh.computePositions(palette, positions);
    return positions;
}

/// What layer 1 does with the weight: it plays a clip, or the application poses it.
struct WeightCase
{
    const char* clip; ///< of the base layer, at its end: 1 after "rise", 0 after "fall"
    const char* over; ///< the layer's clip, also at its end; null: it is posed
    float posed;
    AnimationLayer::Mode mode;
    AnimationLayer::Reference reference;
    double weight; ///< of both
};

using Mode = AnimationLayer::Mode;
using Reference = AnimationLayer::Reference;

const WeightCase weightCases[] = {
    {"fall", "fall", 0, Mode::Additive, Reference::FirstFrame, -1.0},
    {"fall", "fall", 0, Mode::Additive, Reference::RestPose, -0.25},
    {"rise", "rise", 0, Mode::Additive, Reference::FirstFrame, 2.0},
    {"rise", "rise", 0, Mode::Additive, Reference::RestPose, 1.75},
    {"rise", nullptr, 0, Mode::Override, Reference::RestPose, 0.0},
    {"rise", nullptr, 7, Mode::Override, Reference::RestPose, 7.0},
    {"rise", nullptr, -30, Mode::Override, Reference::RestPose, -30.0},
    {"rise", nullptr, 5, Mode::Additive, Reference::RestPose, 5.75},
    {"rise", nullptr, -9, Mode::Additive, Reference::RestPose, -8.25},
    {"fall", nullptr, -1, Mode::Additive, Reference::RestPose, -1.25},
};

TEST(CharacterBoundsTest, holdMorphWeightsThatLayersRaiseLowerAndPose)
{
    for (const WeightCase& c : weightCases)
        for (const float lift : {1.0f, -1.0f})
        {
            SCOPED_TRACE(testing::Message()
                         << c.clip << (c.over ? ", added to " : ", posed to ") << c.weight << " of " << lift);
            const osg::ref_ptr<AnimatedCharacter> character = makeMorphedCharacter(lift);
            AnimationController& controller = character->getController();
            AnimationLayer& over = controller.layer(1);
            over.setMode(c.mode, c.reference);
            for (AnimationLayer* layer : {&controller.layer(0), &over})
                layer->setLoopMode(LoopMode::Once);
            ASSERT_TRUE(controller.play(c.clip));
            ASSERT_TRUE(!c.over || over.play(c.over));
            for (const double time : {0.0, 1.0})
                character->update(time);
            ASSERT_TRUE(c.over || over.pose().setMorphWeight(0, 0, c.posed));
            character->update(1.0);
            const auto& square = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
            const std::vector<glm::dvec3> positions = positionsOf(square, controller);
            EXPECT_NEAR(positions.at(0).z, lift * c.weight, 1e-5);
            for (const glm::dvec3& position : positions)
                for (const osg::BoundingBox& box : {character->getCurrentBounds(), square.getBoundingBox()})
                    EXPECT_TRUE(box.contains(osg::Vec3d(position.x, position.y, position.z))) << position.z;
        }
}

osg::BoundingBox boundsOf(osg::Node& node)
{
    osg::ComputeBoundsVisitor visitor;
    node.accept(visitor);
    return visitor.getBoundingBox();
}

void expectBox(const osg::BoundingBox& box, const osg::Vec3& min, const osg::Vec3& max)
{
    EXPECT_LT((box._min - min).length(), 1e-3f) << box._min.x() << ' ' << box._min.y() << ' ' << box._min.z();
    EXPECT_LT((box._max - max).length(), 1e-3f) << box._max.x() << ' ' << box._max.y() << ' ' << box._max.z();
}

/// Two clones side by side: the one shifts, the other turns.
osg::ref_ptr<osg::Group> makeTwo()
{
    osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(makeTestCharacter());
    osg::ref_ptr<AnimatedCharacter> clone =
        osg::clone(dynamic_cast<AnimatedCharacter*>(both->getChild(0)), osg::CopyOp::DEEP_COPY_NODES);
    clone->setMatrix(osg::Matrix::translate(100, 0, 0));
    both->addChild(clone);
    EXPECT_TRUE(clone->getController().play("turn"));
    return both;
}

TEST(BoundsVisitorsTest, getWhatACharacterPlaysNow)
{
    const osg::ref_ptr<osg::Group> both = makeTwo();
    auto& shifting = dynamic_cast<AnimatedCharacter&>(*both->getChild(0));
    // The square is 1 unit wide and shifts by 2.
    expectBox(boundsOf(shifting), {0, 0, 0}, {3, 0, 1});
    const osg::BoundingBox turning = dynamic_cast<AnimatedCharacter&>(*both->getChild(1)).getCurrentBounds();
    expectBox(boundsOf(*both->getChild(1)), turning._min + osg::Vec3(100, 0, 0), turning._max + osg::Vec3(100, 0, 0));
    EXPECT_LT(turning.zMin(), -0.9f);
    ASSERT_TRUE(shifting.getController().crossfade("turn", 1.0));
    expectBox(boundsOf(shifting), shifting.getCurrentBounds()._min, shifting.getCurrentBounds()._max);
    EXPECT_LT(boundsOf(shifting).zMin(), -0.9f);
    // Other children belong to it; masked meshes do not.
    osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(osg::Matrix::translate(-10, 0, 0));
    osg::ref_ptr<osg::Drawable> thing = new osg::Drawable;
    thing->setInitialBound(osg::BoundingBox(0, 0, 0, 1, 1, 1));
    beside->addChild(thing);
    shifting.addChild(beside);
    EXPECT_NEAR(boundsOf(shifting).xMin(), -10.0f, 1e-3f);
    EXPECT_GE(boundsOf(shifting).xMax(), 3.0f);
    shifting.getChild(0)->setNodeMask(0);
    expectBox(boundsOf(shifting), {-10, 0, 0}, {-9, 1, 1});
}

TEST(BoundsVisitorsTest, getWhatACrowdsInstancesPlayNow)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    const AnimatedCrowd::Instance first = crowd->add(osg::Matrixd::translate(10, 20, 30), playing("shift")).value();
    expectBox(boundsOf(*crowd), {10, 20, 30}, {13, 20, 31});
    addInstances(*crowd, {osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::translate(50, 0, 0)}, playing("shift"));
    expectBox(boundsOf(*crowd), {10, 0, 0}, {56, 20, 31});
    crowd->getController(first)->setLoopMode(LoopMode::Once); // a clip that plays once keeps a controller
    expectBox(boundsOf(*crowd), {10, 0, 0}, {56, 20, 31});
    ASSERT_TRUE(crowd->getController(first)->crossfade("turn", 1.0));
    crowd->update(0.0);
    EXPECT_LT(boundsOf(*crowd).zMax(), 40.0f);
    EXPECT_LE(boundsOf(*crowd).xMin(), 10.0f);
}

} // namespace

} // namespace osgGpuAnimation
