// SPDX-License-Identifier: MIT
#include "support/GaitSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace osgGpuAnimation
{

std::size_t allocationCount(); // see AllocationCount.cpp

// Storage grows with the number of clips that fade at the same time and is then reused.
TEST(AllocationTest, playingDoesNotAllocate)
{
    const auto gaits = makeGaitSet(), moving = withRootMotion(*gaits, "hips", {true, true, true}).value();
    const auto space =
        BlendSpace::create(*gaits, {{"Walk", 0, 0}, {"Run", 1, 0}, {"Idle", 0, 1}, {"Turn", 1, 1}}).value();
    const StateGraphDescription states{{{"stand", "Idle"}, {"go", "Walk"}},
                                       {{"stand", "go", {"speed > 0.5"}}, {"go", "stand", {"speed <= 0.5"}, 0.5}},
                                       "stand"};
    StateMachine machine(StateGraph::create(*gaits, states).value());
    const std::string speed = "speed";
    std::size_t events = 0;
    struct Case
    {
        const char* name;
        std::shared_ptr<const AnimationSet> set;
        std::function<void(AnimationController&, int)> change; ///< before each frame
    };
    const Case cases[] = {
        {"a loop with root motion", moving, [](AnimationController& c, int i) { (void)(i == 0 && c.play(1)); }},
        {"crossfades above another layer", gaits,
         [](AnimationController& c, int i)
         {
             if (i == 0) (void)c.layer(1).play("Turn");
             if (i % 7 == 0) (void)c.crossfade(static_cast<std::size_t>(i % 3), 0.3);
         }},
        {"events", gaits,
         [&](AnimationController& c, int i)
         {
             if (i == 0) c.setEventCallback([&](const AnimationEvent&) { ++events; });
             if (i % 9 == 0) (void)c.crossfade(i % 2 == 0 ? 1 : 2, 0.1);
         }},
        {"a blend space", gaits,
         [&](AnimationController& c, int i)
         {
             if (i == 0) (void)c.play(space);
             c.setParameter(0.5 + 0.6 * std::sin(0.1 * i), 0.5 + 0.6 * std::cos(0.13 * i));
         }},
        {"a state machine", gaits,
         [&](AnimationController& c, int i)
         {
             EXPECT_TRUE(machine.set(speed, i % 40 < 20 ? 1.0 : 0.0));
             machine.update(c, 0.037);
         }},
    };
    for (const Case& each : cases)
    {
        AnimationController controller(each.set);
        std::size_t before = 0;
        for (int i = 0; i < 600; ++i)
        {
            if (i == 120) before = allocationCount();
            each.change(controller, i);
            controller.advance(0.037);
        }
        EXPECT_EQ(allocationCount(), before) << each.name;
        EXPECT_TRUE(controller.isPlaying()) << each.name;
    }
    EXPECT_GT(events, 50u);
}

} // namespace osgGpuAnimation
