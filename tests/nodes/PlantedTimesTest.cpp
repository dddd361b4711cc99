// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/PlantedTimes.h>

#include "nodes/Walker.h"

#include <osgGpuAnimation/animation/AnimationController.h>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>

// The left foot of the Walker. Markers: "Stand" (2 s) plants it from 1.5 s to 0.5 s in the next round, "Walk" (0.9 s)
// from 0.2 s to 0.4 s.

namespace osgGpuAnimation
{

namespace
{

constexpr double never = std::numeric_limits<double>::infinity();

std::shared_ptr<const AnimationSet> markedSet()
{
    const std::shared_ptr<const AnimationSet> set = Walker::makeSet();
    std::vector<Clip> clips = set->clips();
    clips[0] = clips[0].withMarkers({{0.2, "down"}, {0.4, "up"}}).value();
    clips[1] = clips[1].withMarkers({{0.5, "up"}, {1.5, "down"}}).value();
    ClipBuilder pose(set->skeleton(), {});
    EXPECT_TRUE(pose.add({Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0.0}, {0.0, 1.0, 0.0}}));
    clips.push_back(pose.build("Pose"));
    return set->withClips(clips).value();
}

struct PlantedCase
{
    const char* name;
    std::function<void(AnimationController&)> change; ///< of a controller that plays "Stand"
    bool isPlanted;
    double secondsToTouch = never;
};

void layWalkOver(AnimationController& controller, float weight, AnimationLayer::Mode mode)
{
    controller.seek(0.2);
    AnimationLayer& layer = controller.layer(1);
    layer.setMode(mode);
    EXPECT_TRUE(layer.play("Walk"));
    layer.seek(0.1);
    layer.setWeight(weight);
}

const PlantedCase plantedCases[] = {
    {"in the next round", [](auto& c) { c.seek(0.2); }, true},
    {"just before the touch", [](auto& c) { c.seek(1.499); }, false, 0.001},
    {"at the touch", [](auto& c) { c.seek(1.5); }, true},
    {"just before it leaves", [](auto& c) { c.seek(0.499); }, true},
    {"when it leaves", [](auto& c) { c.seek(0.5); }, false, 1.0},
    {"at twice the speed",
     [](auto& c)
     {
         c.seek(1.0);
         c.setSpeed(2.0);
     },
     false, 0.25},
    {"backwards",
     [](auto& c)
     {
         c.seek(1.0);
         c.setSpeed(-1.0);
     },
     false},
    {"back and forth",
     [](auto& c)
     {
         c.setLoopMode(LoopMode::PingPong);
         c.seek(1.0);
     },
     false},
    {"paused",
     [](auto& c)
     {
         c.seek(1.0);
         c.pause();
     },
     false},
    {"a touch in the next round",
     [](auto& c)
     {
         EXPECT_TRUE(c.play("Walk"));
         c.seek(0.6);
     },
     false, 0.5},
    {"no next round",
     [](auto& c)
     {
         c.setLoopMode(LoopMode::Once);
         EXPECT_TRUE(c.play("Walk"));
         c.seek(0.6);
     },
     false},
    {"a clip of one pose", [](auto& c) { EXPECT_TRUE(c.play("Pose")); }, true},
    {"a layer of more than half the weight", [](auto& c) { layWalkOver(c, 0.6f, AnimationLayer::Mode::Override); },
     false, 0.1},
    {"a layer of less", [](auto& c) { layWalkOver(c, 0.4f, AnimationLayer::Mode::Override); }, true},
    {"an additive layer", [](auto& c) { layWalkOver(c, 1.0f, AnimationLayer::Mode::Additive); }, true},
    {"a quarter of a crossfade",
     [](auto& c)
     {
         EXPECT_TRUE(c.crossfade("Walk", 0.2));
         c.advance(0.05);
     },
     true},
    {"three quarters of a crossfade",
     [](auto& c)
     {
         EXPECT_TRUE(c.crossfade("Walk", 0.2));
         c.advance(0.15);
     },
     false, 0.05},
};

} // namespace

TEST(PlantedTimesTest, areThoseOfTheMarkersOfWhatDecidesTheFoot)
{
    const std::shared_ptr<const AnimationSet> set = markedSet();
    PlantedTimes times(set->skeleton().jointNamed("foot.L").value(), set->skeleton().jointNamed("toes.L").value(),
                       "down", "up");
    for (const PlantedCase& c : plantedCases)
    {
        SCOPED_TRACE(c.name);
        AnimationController controller(set);
        ASSERT_TRUE(controller.play("Stand"));
        c.change(controller);
        const PlantedTimes::Now now = times.now(controller);
        EXPECT_EQ(now.isPlanted, c.isPlanted);
        if (c.secondsToTouch == never)
            EXPECT_EQ(now.secondsToTouch, never);
        else
            EXPECT_NEAR(now.secondsToTouch, c.secondsToTouch, 1e-6); // durations are floats
    }
}

TEST(PlantedTimesTest, aLandingHasThePlacesOfTheClipAtItsTouch)
{
    const std::shared_ptr<const AnimationSet> set = markedSet();
    PlantedTimes times(set->skeleton().jointNamed("foot.L").value(), set->skeleton().jointNamed("toes.L").value(),
                       "down", "up");
    AnimationController controller(set);
    ASSERT_TRUE(controller.play("Stand"));
    controller.seek(1.4);
    const PlantedTimes::Now now = times.now(controller);
    EXPECT_LT(glm::distance(now.ankle, glm::dvec3(0.1, 0.08, 0.0)), 1e-4);
    EXPECT_LT(glm::distance(now.contact, glm::dvec3(0.1, 0.02, 0.14)), 1e-4);
}

} // namespace osgGpuAnimation
