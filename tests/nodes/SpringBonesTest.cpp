// SPDX-License-Identifier: MIT
#include "nodes/UpdateVisits.h"
#include "support/NotifyLog.h"
#include "support/Results.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SpringBones.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <osg/MatrixTransform>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

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

/// A character with spring chains, in a scene.
struct Swinging
{
    Swinging(std::shared_ptr<const AnimationSet> set, std::vector<SpringChain> chains,
             std::vector<SpringCollider> colliders)
        : character(new AnimatedCharacter(std::move(set)))
    {
        EXPECT_TRUE(springs->setChains(character->getAnimationSet(), std::move(chains), std::move(colliders)));
        character->addUpdateCallback(springs);
        place->addChild(character);
    }

    void updateTo(double time) { updates.visit(*place, time); }
    /// From time 0 on, 60 frames a second.
    void update(double seconds)
    {
        for (int frame = 0; frame <= std::lround(60.0 * seconds); ++frame)
            updateTo(frame / 60.0);
    }

    /// In world space.
    osg::Vec3d joint(const std::string& name) const
    {
        return (character->jointToModel(name).value() * character->getMatrix() * place->getMatrix()).getTrans();
    }
    osg::Vec3d direction(const std::string& from, const std::string& to) const
    {
        osg::Vec3d way = joint(to) - joint(from);
        way.normalize();
        return way;
    }

    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    osg::ref_ptr<AnimatedCharacter> character;
    osg::ref_ptr<SpringBones> springs = new SpringBones;
    UpdateVisits updates;
};

struct Dog : Swinging
{
    explicit Dog(std::vector<SpringChain> chains = {tail()}, std::vector<SpringCollider> colliders = {},
                 double duration = 2.0)
        : Swinging(dog(duration), std::move(chains), std::move(colliders))
    {
        EXPECT_TRUE(character->setFileToNode(osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0))));
        EXPECT_TRUE(character->getController().play("wag"));
    }
};

/// VRMC_springBone 1.0, "SpringBone Algorithm", for the dog's tail, in double precision. It takes the poses of the body
/// from a controller of its own.
class ReferenceChain
{
public:
    ReferenceChain(const Dog& dog, const std::vector<SpringCollider>& colliders)
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

SpringChain heavyChain(std::initializer_list<const char*> names)
{
    SpringChain chain;
    for (const char* name : names)
        chain.joints.push_back({name, 0.0f, 1.0f, 10.0f});
    return chain;
}

Joint jointAt(const char* name, int parent, const glm::vec3& place, const glm::vec3& scale = glm::vec3(1.0f))
{
    Joint joint{name, parent, {}, -1};
    joint.rest.translation = glm::vec4(place, 0.0f);
    joint.rest.scale = glm::vec4(scale, 0.0f);
    return joint;
}

/// A horizontal rod of four joints.
std::vector<Joint> rod()
{
    return {jointAt("a", -1, {0, 0, 1}), jointAt("b", 0, {0.3f, 0, 0}), jointAt("c", 1, {0.3f, 0, 0}),
            jointAt("d", 2, {0.3f, 0, 0})};
}

/// The clip "turn" holds joint "b" at an angle.
std::shared_ptr<const AnimationSet> turning(const std::vector<Joint>& joints)
{
    AnimationParts parts{Skeleton::create(joints).value(), {}, {}, {}, {}};
    ClipBuilder builder(parts.skeleton, {});
    EXPECT_TRUE(builder.add({Channel::Path::Rotation,
                             Channel::Interpolation::Linear,
                             parts.skeleton.findJoint("b"),
                             {0, 1},
                             {0, 0.6, 0, 0.8, 0, 0.6, 0, 0.8}}));
    parts.clips.push_back(builder.build("turn"));
    return AnimationSet::create(std::move(parts)).value();
}

/// A character of these joints in the axes of its file.
struct Hanging : Swinging
{
    Hanging(const std::vector<Joint>& joints, std::vector<SpringChain> chains,
            std::vector<SpringCollider> colliders = {})
        : Swinging(turning(joints), std::move(chains), std::move(colliders))
    {
    }
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
        ReferenceChain reference(dog, colliders);
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
    double largest = 0.0, sum = 0.0;
    for (int frame = 1; frame <= 480; ++frame) // 240 frames a second
    {
        const osg::Vec3d last = dog.joint("tail3");
        dog.updateTo(frame / 240.0);
        if (frame <= 120) continue;
        const double way = (dog.joint("tail3") - last).length();
        largest = std::max(largest, way);
        sum += way;
    }
    EXPECT_LT(largest, 4.0 * sum / 360.0); // with whole substeps alone every fourth frame would move four times as far
}

TEST(SpringBonesTest, jumpsResetTheChains)
{
    struct Case
    {
        const char* name;
        std::function<void(Dog&)> jump;
        bool resets;
    };
    const Case cases[] = {
        {"none", [](Dog&) {}, false},
        {"a faster clip", [](Dog& dog) { dog.character->getController().setSpeed(1.5); }, false},
        {"seek", [](Dog& dog) { dog.character->getController().seek(1.7); }, true},
        {"reset", [](Dog& dog) { dog.springs->reset(); }, true},
        {"seek on another layer", [](Dog& dog) { dog.character->getController().layer(1).seek(1.7); }, true},
        {"a time that is 1.25 s later", [](Dog& dog) { dog.updateTo(2.25); }, true},
        {"an earlier time", [](Dog& dog) { dog.updateTo(0.25); }, true},
    };
    for (const Case& each : cases)
    {
        Dog dog, stiff(std::vector<SpringChain>{});
        for (Dog* one : {&dog, &stiff})
        {
            EXPECT_TRUE(one->character->getController().layer(1).play("wag"));
            one->update(1.0);
            const unsigned int frame = one->updates.frame;
            each.jump(*one);
            if (one->updates.frame == frame) one->updateTo(1.0);
        }
        const double off = (dog.joint("tail3") - stiff.joint("tail3")).length();
        if (each.resets)
            EXPECT_LT(off, 1e-5) << each.name;
        else
            EXPECT_GT(off, 0.02) << each.name;
    }
}

// Scaled characters swing as the unscaled do: all lengths are in the units of the file. A second place is no other
// pose.
TEST(SpringBonesTest, charactersThatAreScaledOrTwiceInTheSceneSwingAlike)
{
    SpringChain chain = tail();
    chain.colliders = {0, 1};
    Dog plain({chain}, obstacles()), large({chain}, obstacles()), twice({chain}, obstacles());
    large.place->setMatrix(osg::Matrixd::scale(100, 100, 100));
    const osg::ref_ptr<osg::MatrixTransform> other = new osg::MatrixTransform(osg::Matrixd::translate(50, 0, 0));
    other->addChild(twice.character);
    twice.place->addChild(other);
    const auto tailOf = [](const Dog& each) { return each.character->jointToModel("tail3").value().getTrans(); };
    for (Dog* each : {&plain, &large, &twice})
        each->update(2.0);
    EXPECT_LT((tailOf(plain) - tailOf(large)).length(), 1e-4);
    EXPECT_LT((tailOf(plain) - tailOf(twice)).length(), 1e-6);
}

TEST(SpringBonesTest, beyondTheDistanceTheClipsAloneAreShown)
{
    Dog dog, stiff(std::vector<SpringChain>{});
    dog.springs->setMaxDistance(20.0);
    dog.place->setMatrix(osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::translate(100, 0, 0)); // the eye is in the world
    stiff.place->setMatrix(dog.place->getMatrix());
    // The second is drawn by two cameras.
    const std::pair<std::vector<double>, bool> drawn[] = {{{19}, true}, {{21}, false}, {{50, 5}, true}, {{}, false}};
    double time = 0.0;
    for (const auto& [distances, swings] : drawn)
    {
        for (int frame = 0; frame < 60; ++frame)
        {
            for (const double away : distances)
                dog.updates.cullFrom(osg::Vec3d(100, -away, 0), osg::Vec3d(100, 0, 0), {dog.place, dog.character},
                                     *dog.springs);
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

TEST(SpringBonesTest, hugeTimesEnd)
{
    Dog dog;
    for (int i = 0; i < 3; ++i)
        dog.updateTo(1.8e18); // nanoseconds since 1970
    EXPECT_TRUE(dog.joint("tail3").valid());
}

TEST(SpringBonesTest, withoutStiffnessScaledJointsHangStraightDown)
{
    Hanging hanging({jointAt("root", -1, {1, 2, 3}, {1, 1, 2}), jointAt("a", 0, {0, 0, 1}, {2, 1, 0.5f}),
                     jointAt("b", 1, {0.3f, 0.2f, 0.1f}, {1, 3, 1}), jointAt("c", 2, {0.1f, 0.3f, 0.2f})},
                    {heavyChain({"a", "b", "c"})});
    hanging.place->setMatrix(osg::Matrixd::rotate(0.7, osg::Vec3d(1, 1, 0)) * osg::Matrixd::translate(5, 0, 0));
    hanging.update(3.0);
    for (const auto& [from, to] : {std::pair("a", "b"), std::pair("b", "c")})
        EXPECT_LT((hanging.direction(from, to) - osg::Vec3d(0, 0, -1)).length(), 1e-3) << from;
}

TEST(SpringBonesTest, jointsReturnToTheRestOfTheSkeletonWhateverTheClipDoes)
{
    Hanging animated(rod(), {{{{"b", 5.0f, 0.5f}, {"c", 5.0f, 0.5f}, {"d"}}, {}}});
    ASSERT_TRUE(animated.character->getController().play("turn"));
    animated.update(1.0);
    EXPECT_LT((animated.direction("b", "c") - osg::Vec3d(1, 0, 0)).length(), 1e-4);
    EXPECT_TRUE(animated.springs->setChains({}));
    animated.updateTo(1.1);
    EXPECT_LT((animated.direction("b", "c") - osg::Vec3d(0.28, 0, -0.96)).length(), 1e-4) << "the clip";
}

TEST(SpringBonesTest, chainsMayBeListedInAnyOrder)
{
    const SpringChain upper = heavyChain({"a", "b"}), lower = heavyChain({"c", "d"});
    Hanging one(rod(), {upper, lower}), other(rod(), {lower, upper});
    for (Hanging* each : {&one, &other})
        each->update(0.2);
    EXPECT_LT((one.joint("d") - other.joint("d")).length(), 1e-6);
    EXPECT_LT(other.direction("a", "b").z(), -0.5);
    EXPECT_LT(other.direction("c", "d").z(), -0.5);
}

TEST(SpringBonesTest, longFramesOfAMovingCharacterHaveTheSubstepsOfShortOnes)
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

TEST(SpringBonesTest, collidersOnAChainSwingWithIt)
{
    // The pushed chain comes before the one that carries the ball.
    const std::vector<Joint> joints = {jointAt("root", -1, {0, 0, 0}), jointAt("b", 0, {0.1f, 0, 0}),
                                       jointAt("tip", 1, {0, 0, -1}), jointAt("a", 0, {0, 0, 0}),
                                       jointAt("ball", 3, {1, 0, 0})};
    SpringChain pushed = heavyChain({"b", "tip"});
    pushed.joints[0].radius = 0.1f;
    pushed.colliders = {0};
    Hanging hanging(joints, {pushed, heavyChain({"a", "ball"})}, {{"ball", {}, std::nullopt, 0.3f}});
    hanging.update(3.0);
    ASSERT_LT(hanging.direction("a", "ball").z(), -0.99);
    EXPECT_NEAR((hanging.joint("tip") - hanging.joint("ball")).length(), 0.4, 0.02);
}

TEST(SpringBonesTest, theLayerIsTheOneThatWasSelected)
{
    const std::pair<std::size_t, std::size_t> layers[] = {{2, 3}, {maxLayers - 1, maxLayers}, {99, maxLayers}};
    for (const auto& [layer, count] : layers)
    {
        Hanging hanging(rod(), {heavyChain({"a", "b"})});
        hanging.springs->setLayer(layer);
        hanging.update(0.1);
        EXPECT_EQ(hanging.character->getController().layerCount(), count);
        EXPECT_EQ(hanging.springs->getLayer(), count - 1);
        EXPECT_LT(hanging.direction("a", "b").z(), -0.1);
    }
}

TEST(SpringBonesTest, chainsFadeOutAndInWithinAQuarterSecond)
{
    Hanging hanging(rod(), {heavyChain({"a", "b"})});
    hanging.update(1.0);
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

TEST(SpringBonesTest, faultsAreNamedAndChangeNothing)
{
    struct Case
    {
        const char* message;
        std::function<void(SpringChain&, std::vector<SpringCollider>&)> spoil;
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Case cases[] = {
        {"tial", [](auto& chain, auto&) { chain.joints[1].joint = "tial"; }},
        {"no descendant", [](auto& chain, auto&) { std::swap(chain.joints[0], chain.joints[2]); }},
        {"twice", [](auto& chain, auto&) { chain.joints[1] = chain.joints[0]; }},
        {"1 joints", [](auto& chain, auto&) { chain.joints.resize(1); }},
        {"its stiffness is nan", [&](auto& chain, auto&) { chain.joints[0].stiffness = nan; }},
        {"its stiffness is inf, not in [0, infinity)",
         [](auto& chain, auto&) { chain.joints[0].stiffness = HUGE_VALF; }},
        {"its drag is 1.500000, not in [0, 1]", [](auto& chain, auto&) { chain.joints[0].drag = 1.5f; }},
        {"its drag is -0.100000, not in [0, 1]", [](auto& chain, auto&) { chain.joints[1].drag = -0.1f; }},
        {"its gravity is nan, not finite", [&](auto& chain, auto&) { chain.joints[0].gravity = nan; }},
        {"its gravity's direction has length 0.500000, not 1",
         [](auto& chain, auto&) { chain.joints[2].gravityDirection = osg::Vec3(0, 0.5f, 0); }},
        {"its radius is -1.000000, not in [0, infinity)", [](auto& chain, auto&) { chain.joints[0].radius = -1.0f; }},
        {"no collider 2", [](auto& chain, auto&) { chain.colliders = {2}; }},
        {"wing", [](auto&, auto& colliders) { colliders[0].joint = "wing"; }},
        {"collider 1", [&](auto&, auto& colliders) { colliders[1].radius = nan; }},
        {"collider 0", [&](auto&, auto& colliders) { colliders[0].center.z() = nan; }},
        {"collider 1", [&](auto&, auto& colliders) { colliders[1].tail->x() = nan; }},
    };
    Dog dog;
    for (const Case& each : cases)
    {
        SpringChain chain = tail();
        std::vector<SpringCollider> colliders = obstacles();
        each.spoil(chain, colliders);
        EXPECT_TRUE(
            hasError(dog.springs->setChains(dog.character->getAnimationSet(), {chain}, colliders), each.message));
        EXPECT_EQ(dog.springs->getChains().size(), 1u);
        EXPECT_TRUE(dog.springs->getColliders().empty());
    }
}

TEST(SpringBonesTest, jointsOfTwoChainsOrOnePlaceAreFaultsAndEndsOfRangesAreTaken)
{
    Hanging hanging(
        {jointAt("a", -1, {}), jointAt("b", 0, {1, 0, 0}), jointAt("same place", 1, {}), jointAt("c", 1, {0, 1, 0})},
        {});
    const AnimationSet& set = hanging.character->getAnimationSet();
    const std::pair<std::vector<SpringChain>, const char*> faults[] = {
        {{{{{"b"}, {"same place"}}, {}}}, "joint \"same place\": it has the place of the joint before it"},
        {{{{{"a"}, {"b"}}, {}}, {{{"b"}, {"c"}}, {}}}, "chain 1, joint \"b\": it is in two chains"}};
    for (const auto& [chains, message] : faults)
    {
        EXPECT_TRUE(hasError(hanging.springs->setChains(set, chains), message));
    }
    for (const SpringJoint& joint : {SpringJoint{"a", 0.0f, 0.0f}, SpringJoint{"a", 1e6f, 1.0f, -9.0f}})
        EXPECT_TRUE(hanging.springs->setChains(set, {{{joint, {"b"}}, {0}}}, {{"b", {}, std::nullopt, 0.0f}}));
}

TEST(SpringBonesTest, anotherCharacterWithoutTheJointsStaysAsItIs)
{
    const Dog dog;
    const osg::ref_ptr<AnimatedCharacter> stranger = new AnimatedCharacter;
    stranger->addUpdateCallback(dog.springs);
    const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
    osg::setNotifyHandler(log);
    UpdateVisits updates;
    for (int frame = 0; frame < 3; ++frame)
        updates.visit(*stranger, frame / 60.0);
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
    EXPECT_NE(log->text.find("tail0"), std::string::npos) << log->text;
    EXPECT_EQ(log->text.find("chain 0"), log->text.rfind("chain 0")) << "one warning";
}

TEST(SpringBonesTest, copiesHaveAllSettings)
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
