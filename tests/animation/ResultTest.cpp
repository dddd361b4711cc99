// SPDX-License-Identifier: MIT
#include "support/GaitSet.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/StateMachine.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace osgGpuAnimation
{

namespace
{

// In every kind of build: an error whose value is taken ends the program with its message.
TEST(ResultDeathTest, TheValueOfAnErrorEndsTheProgramWithTheMessage)
{
    const Result<int> error = Error{"clip \"Fly\" is not there"};
    const std::string said = "value\\(\\) of a Result that holds the error: clip \"Fly\" is not there";
    EXPECT_DEATH((void)error.value(), said);
    EXPECT_DEATH((void)Result<std::unique_ptr<int>>(Error{error.error()}).value(), said);
    EXPECT_DEATH((void)Result<int>(7).error(), "error\\(\\) of a Result that holds a value");
    EXPECT_EQ(Result<int>(7).value(), 7);
    EXPECT_EQ(*Result<std::unique_ptr<int>>(std::make_unique<int>(8)).value(), 8);
}

// A null set counts as one without joints and clips.
TEST(NullSetTest, AControllerAndAStateMachineAnswer)
{
    AnimationController playing(makeGaitSet());
    ASSERT_TRUE(playing.play("Walk"));
    for (AnimationController controller : {AnimationController(nullptr), AnimationController(nullptr, playing)})
    {
        EXPECT_EQ(controller.set().skeleton().jointCount(), 0u);
        EXPECT_NE(controller.sharedSet(), nullptr);
        const Result<void> played = controller.play("Walk");
        ASSERT_FALSE(played);
        EXPECT_EQ(played.error().message, "there is no clip \"Walk\"; the clips are none");
        EXPECT_EQ(controller.advance(0.5).sampleCount, 1u);
        EXPECT_TRUE(controller.isPlainLoop());
    }
    StateMachine machine(nullptr);
    EXPECT_EQ(machine.state(), "");
    EXPECT_FALSE(machine.set("speed", 1.0));
    EXPECT_FALSE(machine.fire("jump"));
    for (int step = 0; step < 3; ++step)
        EXPECT_FALSE(machine.update(playing, 0.5));
    EXPECT_TRUE(playing.isPlaying());
}

} // namespace

} // namespace osgGpuAnimation
