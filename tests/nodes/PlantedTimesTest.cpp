// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/PlantedTimes.h>

#include "nodes/Walker.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

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

/// A controller plays the base clip with one of the layer's clips over it.
struct PlantedCase
{
    const char* name;
    const char* clip;
    double time; ///< of the clip
    bool isPlanted;
    double secondsToTouch = never;
    double speed = 1.0;
    LoopMode loop = LoopMode::Loop;
    float over = 0.0f; ///< the weight of a layer that plays "Walk" from 0.1 s on
    AnimationLayer::Mode mode = AnimationLayer::Mode::Override;
    const char* mask = nullptr; ///< of the layer: a joint and those below it
    double crossfade = 0.0;     ///< seconds that a fade of 0.2 s to "Walk" has run
};

using Mode = AnimationLayer::Mode;

const PlantedCase plantedCases[] = {
    {"in the next round", "Stand", 0.2, true},
    {"just before the touch", "Stand", 1.499, false, 0.001},
    {"at the touch", "Stand", 1.5, true},
    {"just before it leaves", "Stand", 0.499, true},
    {"when it leaves", "Stand", 0.5, false, 1.0},
    {"at twice the speed", "Stand", 1.0, false, 0.25, 2.0},
    {"backwards", "Stand", 1.0, false, never, -1.0},
    {"back and forth", "Stand", 1.0, false, never, 1.0, LoopMode::PingPong},
    {"a touch in the next round", "Walk", 0.6, false, 0.5},
    {"no next round", "Walk", 0.6, false, never, 1.0, LoopMode::Once},
    {"a clip of one pose", "Pose", 0.0, true},
    {"a layer of more than half the weight", "Stand", 0.2, false, 0.1, 1.0, LoopMode::Loop, 0.6f},
    {"a layer of less", "Stand", 0.2, true, never, 1.0, LoopMode::Loop, 0.4f},
    {"an additive layer", "Stand", 0.2, true, never, 1.0, LoopMode::Loop, 1.0f, Mode::Additive},
    {"a layer of the leg", "Stand", 0.2, false, 0.1, 1.0, LoopMode::Loop, 1.0f, Mode::Override, "thigh.L"},
    {"a layer of the other leg", "Stand", 0.2, true, never, 1.0, LoopMode::Loop, 1.0f, Mode::Override, "thigh.R"},
    {"a quarter of a crossfade", "Stand", 0.0, true, never, 1.0, LoopMode::Loop, 0.0f, Mode::Override, nullptr, 0.05},
    {"three quarters of a crossfade", "Stand", 0.0, false, 0.05, 1.0, LoopMode::Loop, 0.0f, Mode::Override, nullptr,
     0.15},
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
        controller.setLoopMode(c.loop);
        ASSERT_TRUE(controller.play(c.clip));
        controller.seek(c.time);
        controller.setSpeed(c.speed);
        if (c.over > 0.0f)
        {
            AnimationLayer& layer = controller.layer(1);
            layer.setMode(c.mode);
            ASSERT_TRUE(layer.play("Walk"));
            layer.seek(0.1);
            layer.setWeight(c.over);
            ASSERT_TRUE(!c.mask || layer.setMask(JointMask::subtree(*set, c.mask).value()));
        }
        if (c.crossfade > 0.0)
        {
            ASSERT_TRUE(controller.crossfade("Walk", 0.2));
            controller.advance(c.crossfade);
        }
        const PlantedTimes::Now now = times.now(controller);
        EXPECT_EQ(now.isPlanted, c.isPlanted);
        if (c.secondsToTouch == never)
            EXPECT_EQ(now.secondsToTouch, never);
        else
            EXPECT_NEAR(now.secondsToTouch, c.secondsToTouch, 1e-6); // durations are floats
    }
    AnimationController paused(set);
    ASSERT_TRUE(paused.play("Stand"));
    paused.seek(1.4);
    // A landing has the places of the clip at its touch.
    EXPECT_LT(glm::distance(times.now(paused).ankle, glm::dvec3(0.1, 0.08, 0.0)), 1e-4);
    EXPECT_LT(glm::distance(times.now(paused).contact, glm::dvec3(0.1, 0.02, 0.14)), 1e-4);
    EXPECT_NEAR(times.now(paused).secondsToTouch, 0.1, 1e-6);
    paused.pause();
    EXPECT_EQ(times.now(paused).secondsToTouch, never);
}

} // namespace osgGpuAnimation
