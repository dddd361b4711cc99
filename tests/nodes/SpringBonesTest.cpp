// SPDX-License-Identifier: MIT
#include "nodes/UpdateVisits.h"
#include "support/NotifyLog.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SpringBones.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <osg/Camera>
#include <osg/MatrixTransform>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

// Spring chains against an integration of VRMC_springBone 1.0 of our own, in double precision.

namespace osgGpuAnimation
{

namespace
{

constexpr int links = 4; ///< joints of the tail

/// A body that walks to and fro, turns and nods, with a tail of 0.3 m a joint and a leg. duration: seconds of its clip.
std::shared_ptr<const AnimationSet> dog(double duration)
{
    std::vector<Joint> joints(3 + links);
    const auto define = [&](std::size_t index, const char* name, int parent, const glm::vec3& place)
    {
        joints[index].name = name;
        joints[index].parent = parent;
        joints[index].rest.translation = glm::vec4(place, 0.0f);
    };
    define(0, "body", -1, {0, 1, 0});
    define(1, "rump", 0, {0, 0.2f, -0.5f});
    define(2, "leg", 0, {0, -0.3f, -0.6f});
    joints[1].rest.rotation = {-0.6f, 0, 0, 0.8f};
    const char* const names[] = {"tail0", "tail1", "tail2", "tail3"};
    for (int i = 0; i < links; ++i)
        define(static_cast<std::size_t>(3 + i), names[i], i == 0 ? 1 : 2 + i, {0, 0, i == 0 ? -0.1f : -0.3f});
    joints[4].rest.rotation = {0, std::sin(0.1f), 0, std::cos(0.1f)};
    AnimationParts parts{Skeleton::create(joints).value(), {}, {}, {}, {}};
    ClipBuilder builder(parts.skeleton, {});
    Channel moves{Channel::Path::Translation, Channel::Interpolation::Linear, 0, {}, {}};
    Channel turns{Channel::Path::Rotation, Channel::Interpolation::Linear, 0, {}, {}};
    for (int key = 0; key <= 60; ++key)
    {
        const double time = duration * key / 60.0, phase = std::acos(-1.0) * key / 30.0;
        moves.times.push_back(time);
        turns.times.push_back(time);
        for (const double value : {0.5 * std::sin(phase), 1.0 + 0.1 * std::sin(2.0 * phase), 0.0})
            moves.values.push_back(value);
        for (const double value : {0.1 * std::sin(phase), std::sin(0.3 * std::sin(phase)), 0.0, 0.95})
            turns.values.push_back(value);
    }
    EXPECT_TRUE(builder.add(moves));
    EXPECT_TRUE(builder.add(turns));
    parts.clips.push_back(builder.build("wag"));
    return AnimationSet::create(std::move(parts)).value();
}

SpringChain tail()
{
    SpringChain chain;
    for (const char* name : {"tail0", "tail1", "tail2", "tail3"})
        chain.joints.push_back({name, 2.0f, 0.2f, 0.5f, osg::Vec3(0, 0.6f, -0.8f), 0.05f});
    chain.joints[1].stiffness = 0.5f;
    return chain;
}

/// They stand where the tail swings.
std::vector<SpringCollider> obstacles()
{
    return {{"leg", osg::Vec3(0.1f, 0, 0), std::nullopt, 0.3f},
            {"body", osg::Vec3(-0.2f, 0, -1), osg::Vec3(-0.2f, 1, -1.2f), 0.1f}};
}

struct Dog
{
    explicit Dog(std::vector<SpringChain> chains = {tail()}, std::vector<SpringCollider> colliders = {},
                 double duration = 2.0)
        : character(new AnimatedCharacter(dog(duration))), springs(new SpringBones)
    {
        EXPECT_TRUE(character->setFileToNode(osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0))));
        EXPECT_TRUE(character->getController().play("wag"));
        EXPECT_TRUE(springs->setChains(character->getAnimationSet(), std::move(chains), std::move(colliders)));
        character->addUpdateCallback(springs);
        place->addChild(character);
    }

    void updateTo(double time) { updates.visit(*place, time); }

    /// In world space.
    osg::Vec3d joint(const std::string& name) const
    {
        const Result<osg::Matrixd> toModel = character->jointToModel(name);
        return (toModel.value() * character->getMatrix() * place->getMatrix()).getTrans();
    }

    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    osg::ref_ptr<AnimatedCharacter> character;
    osg::ref_ptr<SpringBones> springs;
    UpdateVisits updates;
};

/// VRMC_springBone 1.0, "SpringBone Algorithm", for the dog's tail, in double precision. It takes the poses of the body
/// from a controller of its own.
class Reference
{
public:
    Reference(const Dog& dog, const std::vector<SpringCollider>& colliders)
        : _dog(dog), _colliders(colliders), _controller(dog.character->getController())
    {
        _controller.layer(0).seek(0.0);
        advance(true);
    }

    void step()
    {
        _controller.advance(1.0 / 60.0);
        advance(false);
    }

    const glm::dvec3& tailOf(int link) const { return _now[link]; } ///< of tail{link}: the place of the next joint

private:
    glm::dmat4 toWorld(const char* joint) const
    {
        const AnimationSet& set = _dog.character->getAnimationSet();
        const std::size_t index = set.skeleton().jointNamed(joint).value();
        const AffineMatrix toModel = Pose::jointToModel(set, _controller.instruction(), index);
        const osg::Matrixd world = toOsg(toModel) * _dog.character->getFileToNode() * _dog.place->getMatrix();
        return glm::make_mat4(world.ptr());
    }

    void advance(bool isFirst)
    {
        const AnimationSet& set = _dog.character->getAnimationSet();
        glm::dmat4 parent = toWorld("rump");
        for (int link = 0; link + 1 < links; ++link)
        {
            const SpringJoint settings = tail().joints[static_cast<std::size_t>(link)];
            const JointTransform& rest = set.skeleton().joint(static_cast<std::size_t>(3 + link)).rest;
            const glm::dmat4 initial = parent * rest.toMatrix().toColumns();
            const glm::dvec3 head(initial[3]), axis(0, 0, -0.3f);
            const glm::dvec3 atRest(initial * glm::dvec4(axis, 1.0));
            const double length = glm::length(atRest - head);
            if (isFirst) _now[link] = _before[link] = atRest;
            glm::dvec3 next = _now[link];
            if (!isFirst)
            {
                const osg::Vec3 down = settings.gravityDirection;
                next += (_now[link] - _before[link]) * (1.0 - static_cast<double>(settings.drag));
                next += glm::normalize(atRest - head) * (static_cast<double>(settings.stiffness) / 60.0);
                next += glm::dvec3(down.x(), down.y(), down.z()) * (static_cast<double>(settings.gravity) / 60.0);
                next = head + glm::normalize(next - head) * length;
                for (const SpringCollider& collider : _colliders)
                    next = head + glm::normalize(outside(collider, next, 0.05) - head) * length;
                _before[link] = _now[link];
                _now[link] = next;
            }
            const glm::dvec3 to = glm::normalize(glm::dvec3(glm::inverse(initial) * glm::dvec4(next, 1.0)));
            parent = initial * glm::mat4_cast(glm::dquat(glm::normalize(axis), to));
        }
    }

    glm::dvec3 outside(const SpringCollider& collider, glm::dvec3 place, double radius) const
    {
        const glm::dmat4 world = toWorld(collider.joint.c_str());
        const auto at = [&](const osg::Vec3& p) { return glm::dvec3(world * glm::dvec4(p.x(), p.y(), p.z(), 1.0)); };
        glm::dvec3 nearest = at(collider.center);
        if (collider.tail)
        {
            const glm::dvec3 along = at(*collider.tail) - nearest;
            nearest += along * std::clamp(glm::dot(along, place - nearest) / glm::dot(along, along), 0.0, 1.0);
        }
        const double least = static_cast<double>(collider.radius) + radius;
        if (glm::distance(place, nearest) < least) place = nearest + glm::normalize(place - nearest) * least;
        return place;
    }

    const Dog& _dog;
    const std::vector<SpringCollider>& _colliders;
    AnimationController _controller;
    glm::dvec3 _now[links], _before[links];
};

double distance(const osg::Vec3d& a, const glm::dvec3& b)
{
    return (a - osg::Vec3d(b.x, b.y, b.z)).length();
}

} // namespace

TEST(SpringBonesTest, theTailSwingsAsInTheSpecification)
{
    double pushed = 0.0;
    for (const bool hasColliders : {false, true})
    {
        const std::vector<SpringCollider> colliders = hasColliders ? obstacles() : std::vector<SpringCollider>();
        SpringChain chain = tail();
        if (hasColliders) chain.colliders = {0, 1};
        Dog dog({chain}, colliders), free;
        for (Dog* each : {&dog, &free})
            each->place->setMatrix(osg::Matrixd::rotate(1.0, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(40, -7, 3));
        dog.updateTo(0.0);
        free.updateTo(0.0);
        Reference reference(dog, colliders);
        double worst = 0.0;
        for (int frame = 1; frame <= 600; ++frame)
        {
            dog.updateTo(frame / 60.0);
            free.updateTo(frame / 60.0);
            reference.step();
            for (int link = 0; link + 1 < links; ++link)
                worst = std::max(worst, distance(dog.joint("tail" + std::to_string(link + 1)), reference.tailOf(link)));
            pushed = std::max(pushed, (dog.joint("tail3") - free.joint("tail3")).length());
        }
        EXPECT_LT(worst, 1e-4) << "metres, " << (hasColliders ? "with colliders" : "free"); // the bar; floats: 1e-6
    }
    EXPECT_GT(pushed, 0.05); // the colliders are in the way
}

TEST(SpringBonesTest, equalTimesShowEqualPosesAtAnyFrameRate)
{
    SpringChain chain = tail();
    chain.colliders = {0, 1};
    const int rates[] = {30, 60, 144, 7};
    std::vector<Dog> dogs;
    for (std::size_t i = 0; i < std::size(rates); ++i)
        dogs.emplace_back(std::vector<SpringChain>{chain}, obstacles());
    for (Dog& dog : dogs)
        dog.updateTo(0.0);
    std::vector<int> frames(dogs.size());
    for (int second = 1; second <= 10; ++second)
    {
        for (std::size_t i = 0; i < dogs.size(); ++i)
            while (frames[i] < second * rates[i])
                dogs[i].updateTo(static_cast<double>(++frames[i]) / rates[i]);
        for (std::size_t i = 1; i < dogs.size(); ++i)
            EXPECT_LT((dogs[i].joint("tail3") - dogs[0].joint("tail3")).length(), 1e-4)
                << rates[i] << " frames a second, at " << second << " s";
    }
}

TEST(SpringBonesTest, framesBetweenSubstepsMoveEvenly)
{
    Dog dog;
    dog.updateTo(0.0);
    osg::Vec3d last;
    double largest = 0.0, sum = 0.0;
    for (int frame = 1; frame <= 480; ++frame) // 240 frames a second
    {
        dog.updateTo(frame / 240.0);
        const osg::Vec3d now = dog.joint("tail3");
        if (frame > 120)
        {
            const double way = (now - last).length();
            largest = std::max(largest, way);
            sum += way;
        }
        last = now;
    }
    EXPECT_LT(largest, 4.0 * sum / 360.0); // with whole substeps alone every fourth frame would move four times as far
}

struct JumpCase
{
    const char* name;
    std::function<void(Dog&)> jump;
    bool resets;
};

TEST(SpringBonesTest, jumpsResetTheChains)
{
    const JumpCase cases[] = {
        {"none", [](Dog&) {}, false},
        {"a faster clip", [](Dog& dog) { dog.character->getController().setSpeed(1.5); }, false},
        {"seek", [](Dog& dog) { dog.character->getController().seek(1.7); }, true},
        {"reset", [](Dog& dog) { dog.springs->reset(); }, true},
        {"seek on another layer", [](Dog& dog) { dog.character->getController().layer(1).seek(1.7); }, true},
        {"a time that is 1.25 s later", [](Dog& dog) { dog.updateTo(2.25); }, true},
        {"an earlier time", [](Dog& dog) { dog.updateTo(0.25); }, true},
    };
    for (const JumpCase& each : cases)
    {
        Dog dog, stiff(std::vector<SpringChain>{}), fresh;
        for (Dog* one : {&dog, &stiff})
        {
            EXPECT_TRUE(one->character->getController().layer(1).play("wag"));
            for (int frame = 0; frame <= 60; ++frame)
                one->updateTo(frame / 60.0);
        }
        for (Dog* one : {&dog, &stiff})
        {
            each.jump(*one);
            const double time = one->updates.frame > 61 ? one->character->getController().time() : 1.0;
            if (one->updates.frame == 61) one->updateTo(time);
        }
        const double off = (dog.joint("tail3") - stiff.joint("tail3")).length();
        if (each.resets)
            EXPECT_LT(off, 1e-5) << each.name;
        else
            EXPECT_GT(off, 0.02) << each.name;
    }
}

// Scaled characters swing as the unscaled do: all lengths are in the units of the file.
TEST(SpringBonesTest, scaledCharactersSwingAlike)
{
    SpringChain chain = tail();
    chain.colliders = {0, 1};
    Dog small({chain}, obstacles()), large({chain}, obstacles());
    large.place->setMatrix(osg::Matrixd::scale(100, 100, 100));
    for (int frame = 0; frame <= 120; ++frame)
    {
        small.updateTo(frame / 60.0);
        large.updateTo(frame / 60.0);
    }
    EXPECT_LT((small.joint("tail3") * 100.0 - large.joint("tail3")).length(), 100.0 * 1e-4);
}

TEST(SpringBonesTest, charactersThatShareTheCallbackSwingByThemselves)
{
    Dog dog;
    const osg::ref_ptr<osg::MatrixTransform> other =
        osg::clone(dog.place.get(), osg::CopyOp::DEEP_COPY_NODES); // shares the callback
    dog.updateTo(0.0);
    const osg::Vec3d alone = dog.joint("tail3");
    dog.place->addChild(other);
    other->setMatrix(osg::Matrixd::rotate(osg::PI, osg::Vec3d(1, 0, 0)));
    for (int frame = 0; frame <= 60; ++frame)
        dog.updateTo(frame / 60.0);
    const auto tailOf = [](AnimatedCharacter& character) { return character.jointToModel("tail3").value().getTrans(); };
    AnimatedCharacter* second = findCharacter(*other);
    ASSERT_TRUE(second);
    EXPECT_NE(second, dog.character);
    EXPECT_GT((tailOf(*second) - tailOf(*dog.character)).length(), 0.05); // it hangs the other way
    EXPECT_NE(dog.joint("tail3"), alone);
}

TEST(SpringBonesTest, beyondTheDistanceTheClipsAloneAreShown)
{
    Dog dog, stiff(std::vector<SpringChain>{});
    dog.springs->setMaxDistance(20.0);
    dog.character->addCullCallback(dog.springs);
    dog.place->setMatrix(osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::translate(100, 0, 0)); // the eye is in the world
    stiff.place->setMatrix(dog.place->getMatrix());
    const auto seeFrom = [&](double away)
    {
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setViewMatrixAsLookAt(osg::Vec3d(100, -away, 0), osg::Vec3d(100, 0, 0), osg::Vec3d(0, 0, 1));
        const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
        stage->setCamera(camera);
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setFrameNumber(dog.updates.frame);
        const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
        visitor->setFrameStamp(stamp);
        visitor->setRenderStage(stage);
        visitor->setCurrentRenderBin(stage);
        visitor->pushOntoNodePath(dog.place);
        visitor->pushOntoNodePath(dog.character);
        (*dog.springs)(dog.character, visitor);
    };
    // The second is drawn by two cameras.
    const std::pair<std::vector<double>, bool> drawn[] = {{{19}, true}, {{21}, false}, {{50, 5}, true}, {{}, false}};
    double time = 0.0;
    for (const auto& [distances, swings] : drawn)
    {
        for (int frame = 0; frame < 60; ++frame)
        {
            for (const double away : distances)
                seeFrom(away);
            time += 1.0 / 60.0;
            dog.updateTo(time);
            stiff.updateTo(time);
        }
        const double off = (dog.joint("tail3") - stiff.joint("tail3")).length();
        EXPECT_EQ(off > 1e-5, swings) << off << " at " << time << " s";
    }
}

// A loop's end is no seek: in sums of frame times, rounding may put it between two equal times.
TEST(SpringBonesTest, loopsAreNoJumps)
{
    for (const double duration : {0.2, 0.5, 1.2})
        for (const double rate : {24.0, 30.0, 144.0})
        {
            Dog dog({tail()}, {}, duration), stiff({}, {}, duration);
            for (Dog* each : {&dog, &stiff})
                each->character->getController().setSpeed(1.2);
            double least = 1.0;
            for (int frame = 0; frame < 60.0 * rate; ++frame)
            {
                dog.updateTo(frame / rate);
                stiff.updateTo(frame / rate);
                if (frame > rate) least = std::min(least, (dog.joint("tail3") - stiff.joint("tail3")).length());
            }
            EXPECT_GT(least, 1e-5) << duration << " s, " << rate << " frames a second"; // gravity never lets them rest
        }
}

TEST(SpringBonesTest, copiesOfAStoppedCharacterSwing)
{
    Dog dog, stiff(std::vector<SpringChain>{});
    dog.updateTo(0.0);
    dog.springs->setMaxDistance(20.0); // nobody sees it
    for (int frame = 1; frame <= 60; ++frame)
        dog.updateTo(frame / 60.0);
    const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(dog.character.get(), osg::CopyOp::DEEP_COPY_NODES);
    dog.place->setChild(0, copy);
    dog.character = copy;
    dog.springs->setMaxDistance(std::numeric_limits<double>::infinity());
    for (int frame = 0; frame <= 120; ++frame)
    {
        if (frame > 60) dog.updateTo(frame / 60.0);
        stiff.updateTo(frame / 60.0);
    }
    EXPECT_GT((dog.joint("tail3") - stiff.joint("tail3")).length(), 0.02);
}

TEST(SpringBonesTest, severalPlacesOfACharacterAreOnePose)
{
    Dog dog, twice;
    const osg::ref_ptr<osg::MatrixTransform> other = new osg::MatrixTransform(osg::Matrixd::translate(50, 0, 0));
    other->addChild(twice.character);
    twice.place->addChild(other);
    for (int frame = 0; frame <= 100; ++frame)
    {
        dog.updateTo(frame / 144.0);
        twice.updateTo(frame / 144.0);
    }
    const auto tailOf = [](const Dog& each) { return each.character->jointToModel("tail3").value().getTrans(); };
    EXPECT_LT((tailOf(dog) - tailOf(twice)).length(), 1e-6);
}

TEST(SpringBonesTest, jointsOfEarlierChainsReturnToTheClips)
{
    Dog dog, stiff(std::vector<SpringChain>{});
    for (int frame = 0; frame <= 60; ++frame)
    {
        if (frame == 30)
        {
            ASSERT_TRUE(dog.springs->setChains(dog.character->getAnimationSet(), {}));
        }
        dog.updateTo(frame / 60.0);
        stiff.updateTo(frame / 60.0);
    }
    EXPECT_LT((dog.joint("tail3") - stiff.joint("tail3")).length(), 1e-6);
}

TEST(SpringBonesTest, hugeTimesEnd)
{
    Dog dog;
    for (int i = 0; i < 3; ++i)
        dog.updateTo(1.8e18); // nanoseconds since 1970
    EXPECT_TRUE(dog.joint("tail3").valid());
}

struct FaultCase
{
    const char* name;
    std::function<void(SpringChain&, std::vector<SpringCollider>&)> spoil;
    const char* message;
};

TEST(SpringBonesTest, faultsAreNamedAndChangeNothing)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const FaultCase cases[] = {
        {"unknown joint", [](auto& chain, auto&) { chain.joints[1].joint = "tial"; }, "tial"},
        {"no descendant", [](auto& chain, auto&) { std::swap(chain.joints[0], chain.joints[2]); }, "no descendant"},
        {"twice", [](auto& chain, auto&) { chain.joints[1] = chain.joints[0]; }, "twice"},
        {"one joint", [](auto& chain, auto&) { chain.joints.resize(1); }, "1 joints"},
        {"stiffness", [&](auto& chain, auto&) { chain.joints[0].stiffness = nan; }, "stiffness"},
        {"drag", [](auto& chain, auto&) { chain.joints[0].drag = 1.5f; }, "drag"},
        {"gravity", [&](auto& chain, auto&) { chain.joints[0].gravity = nan; }, "gravity"},
        {"direction", [](auto& chain, auto&) { chain.joints[0].gravityDirection = osg::Vec3(); }, "direction"},
        {"radius", [](auto& chain, auto&) { chain.joints[0].radius = -1.0f; }, "radius"},
        {"no collider", [](auto& chain, auto&) { chain.colliders = {2}; }, "no collider 2"},
        {"collider's joint", [](auto&, auto& colliders) { colliders[0].joint = "wing"; }, "wing"},
        {"collider's radius", [&](auto&, auto& colliders) { colliders[1].radius = nan; }, "collider 1"},
        {"collider's centre", [&](auto&, auto& colliders) { colliders[0].center.z() = nan; }, "collider 0"},
        {"collider's place", [&](auto&, auto& colliders) { colliders[1].tail->x() = nan; }, "collider 1"},
    };
    for (const FaultCase& each : cases)
    {
        Dog dog;
        SpringChain chain = tail();
        std::vector<SpringCollider> colliders = obstacles();
        each.spoil(chain, colliders);
        const Result<void> set = dog.springs->setChains(dog.character->getAnimationSet(), {chain}, colliders);
        ASSERT_FALSE(set) << each.name;
        EXPECT_NE(set.error().message.find(each.message), std::string::npos) << set.error().message;
        EXPECT_EQ(dog.springs->getChains().size(), 1u);
        EXPECT_TRUE(dog.springs->getColliders().empty());
    }
}

TEST(SpringBonesTest, anotherCharacterWithoutTheJointsStaysAsItIs)
{
    const Dog dog;
    const osg::ref_ptr<AnimatedCharacter> stranger = new AnimatedCharacter;
    stranger->addUpdateCallback(dog.springs);
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
    osg::setNotifyHandler(log);
    for (int frame = 0; frame < 3; ++frame)
    {
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setSimulationTime(frame / 60.0);
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(stamp);
        stranger->accept(visitor);
    }
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
    EXPECT_NE(log->text.find("tail0"), std::string::npos) << log->text;
    EXPECT_EQ(log->text.find("chain 0"), log->text.rfind("chain 0")) << "one warning";
}

} // namespace osgGpuAnimation
