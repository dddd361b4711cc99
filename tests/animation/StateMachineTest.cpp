// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/StateMachine.h>

#include "support/GaitSet.h"
#include "support/Results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

StateGraphDescription description()
{
    return {{{"stand", "Idle"}, {"go", "Walk", LoopMode::Loop, 1.5}, {"spin", "Turn", LoopMode::Once}},
            {{"stand", "go", {"speed > 0.5"}, 0.25, FadeCurve::Smooth, Sync::Phase},
             {"go", "stand", {"speed <= 0.5", "after 1"}, 0.5},
             {"", "spin", {"spin", "speed >= 0"}, 0.0},
             {"spin", "stand", {"finished"}}},
            "stand"};
}

class StateMachineTest : public ::testing::Test
{
protected:
    StateMachine machineOf(const StateGraphDescription& graph = description(), std::size_t layer = 0) const
    {
        return StateMachine(StateGraph::create(*set, graph).value(), layer);
    }

    const std::shared_ptr<const AnimationSet> set = makeGaitSet();
    AnimationController controller{set};
};

TEST_F(StateMachineTest, takesTransitionsWhoseConditionsHold)
{
    StateMachine machine = machineOf();
    const auto step = [&](double seconds)
    {
        const bool changed = machine.update(controller, seconds);
        controller.advance(seconds);
        return changed;
    };
    EXPECT_TRUE(step(0.1));
    EXPECT_EQ(machine.state(), "stand");
    EXPECT_EQ(controller.clip(), 0);
    EXPECT_FALSE(step(0.1));

    EXPECT_TRUE(machine.set("speed", 1.0));
    EXPECT_TRUE(step(0.1));
    EXPECT_EQ(machine.state(), "go");
    EXPECT_EQ(controller.clip(), 1);
    EXPECT_EQ(controller.layer(0).settings().speed, 1.5);
    EXPECT_TRUE(controller.layer(0).mixer().isFading());
    EXPECT_EQ(controller.layer(0).mixer().activeClip(0).playback.speed(), 1.0) << "what fades out keeps its own";

    EXPECT_TRUE(machine.set("speed", 0.0));
    EXPECT_FALSE(step(0.5)) << "it has to last";
    EXPECT_TRUE(step(0.6));
    EXPECT_EQ(machine.state(), "stand");

    EXPECT_TRUE(machine.fire("spin"));
    EXPECT_TRUE(step(0.1));
    EXPECT_EQ(machine.state(), "spin");
    EXPECT_FALSE(step(2.0)) << "the trigger is used up, the clip ends in this step";
    EXPECT_TRUE(step(0.1));
    EXPECT_EQ(machine.state(), "stand");
    EXPECT_EQ(controller.layer(0).settings().loopMode, LoopMode::Loop);
}

TEST_F(StateMachineTest, aTransitionUsesUpItsOwnTriggersAlone)
{
    StateMachine machine = machineOf({{{"stand", "Idle"}, {"go", "Walk"}, {"run", "Run"}},
                                      {{"stand", "go", {"start", "now"}},
                                       {"go", "run", {"hurry"}},
                                       {"run", "stand", {"start"}},
                                       {"go", "stand", {"now"}}},
                                      "stand"});
    EXPECT_TRUE(machine.update(controller, 0.1));
    EXPECT_TRUE(machine.fire("start"));
    EXPECT_TRUE(machine.fire("hurry"));
    EXPECT_FALSE(machine.update(controller, 0.1)) << "one of its two triggers";
    EXPECT_TRUE(machine.fire("now"));
    EXPECT_TRUE(machine.update(controller, 0.1));
    EXPECT_EQ(machine.state(), "go");
    EXPECT_TRUE(machine.update(controller, 0.1)) << "what was fired earlier is still fired";
    EXPECT_EQ(machine.state(), "run");
    EXPECT_FALSE(machine.update(controller, 0.1)) << "both triggers of the first transition are used up";
    EXPECT_TRUE(machine.fire("start"));
    EXPECT_TRUE(machine.update(controller, 0.1));
    EXPECT_FALSE(machine.update(controller, 0.1)) << "also on the second visit";
    EXPECT_EQ(machine.state(), "stand");
}

TEST_F(StateMachineTest, fromEveryStateButItsOwn)
{
    StateMachine machine = machineOf({{{"stand", "Idle"}, {"go", "Walk"}, {"run", "Run"}},
                                      {{"", "run", {"speed > 2"}}, {"", "go", {"speed > 1"}}},
                                      "stand"});
    EXPECT_TRUE(machine.update(controller, 0.1));
    EXPECT_TRUE(machine.set("speed", 1.5));
    EXPECT_TRUE(machine.update(controller, 0.1));
    controller.advance(0.1);
    EXPECT_FALSE(machine.update(controller, 0.1)) << "it does not enter the state again";
    EXPECT_NEAR(machine.secondsInState(), 0.1, 1e-12);
    EXPECT_TRUE(machine.set("speed", 2.5));
    EXPECT_TRUE(machine.update(controller, 0.1));
    EXPECT_EQ(machine.state(), "run") << "the first of two transitions";
    EXPECT_TRUE(machine.update(controller, 0.1));
    EXPECT_EQ(machine.state(), "go") << "its own transition does not count, the other does";
}

TEST_F(StateMachineTest, theClockOfAStateStartsAtEachVisit)
{
    StateMachine machine = machineOf({{{"stand", "Idle"}, {"go", "Walk"}},
                                      {{"stand", "go", {"after 1"}}, {"go", "stand", {"after 0.75"}}},
                                      "stand"});
    EXPECT_TRUE(machine.update(controller, 5.0)) << "the start state begins here";
    for (int visit = 0; visit < 3; ++visit)
    {
        EXPECT_EQ(machine.secondsInState(), 0.0);
        EXPECT_FALSE(machine.update(controller, 0.75)) << visit;
        EXPECT_TRUE(machine.update(controller, 0.25)) << "after 1 second, not later, " << visit;
        EXPECT_EQ(machine.state(), "go");
        EXPECT_EQ(machine.secondsInState(), 0.0);
        EXPECT_FALSE(machine.update(controller, 0.5)) << visit;
        EXPECT_TRUE(machine.update(controller, 0.25)) << visit;
        EXPECT_EQ(machine.state(), "stand");
    }
}

TEST_F(StateMachineTest, refusesWhatItDoesNotKnow)
{
    StateMachine machine = machineOf(description(), 2);
    const std::pair<Result<void>, const char*> faults[] = {
        {machine.set("height", 1.0), "there is no parameter \"height\"; the parameters are \"speed\""},
        {machine.set("speed", std::nan("")), "parameter \"speed\": its value is nan"},
        {machine.fire("speed"), "there is no trigger \"speed\"; the triggers are \"spin\""}};
    for (const auto& [result, message] : faults)
    {
        ASSERT_FALSE(result) << message;
        EXPECT_EQ(result.error().message, message);
    }
    EXPECT_EQ(machine.value("speed"), 0.0);
    EXPECT_EQ(machine.value("height"), 0.0);
    machine.update(controller, std::nan(""));
    machine.update(controller, -HUGE_VAL);
    EXPECT_EQ(machine.secondsInState(), 0.0);
    EXPECT_EQ(controller.clip(), -1) << "it drives layer 2 alone";
    EXPECT_EQ(controller.layer(2).playback().clip(), 0);
}

TEST_F(StateMachineTest, aControllerOfAnotherSetStaysAsItIs)
{
    const auto poor = set->withClips({set->clips()[0]}).value();
    AnimationController controller(poor);
    StateMachine machine = machineOf();
    EXPECT_TRUE(machine.update(controller, 0.1)) << "the first clip is there";
    EXPECT_TRUE(machine.set("speed", 1.0));
    EXPECT_TRUE(machine.fire("spin"));
    EXPECT_FALSE(machine.update(controller, 0.1));
    EXPECT_EQ(machine.state(), "stand");
    EXPECT_NEAR(machine.secondsInState(), 0.1, 1e-9);
    EXPECT_EQ(controller.clip(), 0);

    AnimationController empty(set->withClips({}).value());
    StateMachine other = machineOf();
    EXPECT_FALSE(other.update(empty, 0.1));
    EXPECT_EQ(empty.clip(), -1);
    AnimationController right(set);
    EXPECT_TRUE(other.update(right, 0.1)) << "it has not begun yet";
}

TEST(StateGraphTest, faultsAreNamed)
{
    struct Case
    {
        void (*spoil)(StateGraphDescription&);
        const char* message;
    };
    using D = StateGraphDescription;
    const Case cases[] = {
        {[](D& d) { d.states.clear(); }, "a state graph without states"},
        {[](D& d) { d.states[1].name = "stand"; }, "state \"stand\": another has this name already"},
        {[](D& d) { d.states[1].name = ""; }, "state \"\": it has no name"},
        {[](D& d) { d.states[2].clip = "Fly"; }, "state \"spin\": there is no clip \"Fly\"; the clips are"},
        {[](D& d) { d.states[1].speed = std::nan(""); }, "state \"go\": its speed is not finite"},
        {[](D& d) { d.start = "run"; }, "start: there is no state \"run\"; the states are \"stand\", \"go\", \"spin\""},
        {[](D& d) { d.transitions[1].from = "run"; }, "transition 1: there is no state \"run\""},
        {[](D& d) { d.transitions[2].to = ""; }, "transition 2: there is no state \"\""},
        {[](D& d) { d.transitions[0].seconds = -1; },
         "transition 0: a crossfade of -1.000000 seconds: expected a finite number, at least 0"},
        {[](D& d) { d.transitions[0].seconds = std::nan(""); }, "transition 0: a crossfade of"},
        {[](D& d) { d.transitions[3].when.clear(); }, "transition 3: it has no conditions"},
        {[](D& d) { d.transitions[0].when = {"speed > fast"}; }, "transition 0: \"speed > fast\" is not a condition"},
        {[](D& d) { d.transitions[0].when = {"finished"}; }, "transition 0: \"finished\" is never true"},
        {[](D& d) { d.transitions[2].when = {"finished"}; }, "transition 2: \"finished\" is never true"},
        {[](D& d) { d.states.resize(1025); }, "a state graph of 1025 states: at most 1024 are possible"},
        {[](D& d) { d.transitions.resize(8193); }, "a state graph of 8193 transitions: at most 8192 are possible"},
        {[](D& d) { d.transitions[0].when = {"speed"}; }, "\"speed\" is used as a trigger and as a parameter"},
    };
    const auto set = makeGaitSet();
    for (const Case& c : cases)
    {
        StateGraphDescription faulty = description();
        c.spoil(faulty);
        EXPECT_TRUE(hasError(StateGraph::create(*set, faulty), c.message));
    }
}

TEST_F(StateMachineTest, eachComparisonBelowAtAndAboveItsNumber)
{
    struct Case
    {
        const char* condition;
        bool below, equal, above;
    };
    const Case cases[] = {
        {"x > 0.5", false, false, true}, {"x >= 0.5", false, true, true},  {"x < 0.5", true, false, false},
        {"x <= 0.5", true, true, false}, {"x == 0.5", false, true, false}, {"x != 0.5", true, false, true},
    };
    for (const Case& c : cases)
    {
        const std::pair<double, bool> values[] = {{0.25, c.below}, {0.5, c.equal}, {0.75, c.above}};
        for (const auto& [value, isTaken] : values)
        {
            StateMachine machine =
                machineOf({{{"stand", "Idle"}, {"go", "Walk"}}, {{"stand", "go", {c.condition}}}, ""});
            EXPECT_TRUE(machine.set("x", value));
            machine.update(controller, 0.1);
            EXPECT_EQ(machine.update(controller, 0.1), isTaken) << c.condition << " at " << value;
        }
    }
}

TEST_F(StateMachineTest, oddConditionsAreReadOrRefused)
{
    using Test = StateCondition::Test;
    const std::pair<const char*, std::optional<Test>> cases[] = {
        {"x>=-0.5", Test::AtLeast},   {"x >=-0.5", Test::AtLeast},  {" x  >=  -0.5 ", Test::AtLeast},
        {"x>= -0.5", Test::AtLeast},  {"x>", std::nullopt},         {"0 < x < 1", std::nullopt},
        {"jump!", std::nullopt},      {"a b c d", std::nullopt},    {"after inf", std::nullopt},
        {"after 0", Test::After},     {"after -1", std::nullopt},   {"after 1 2", std::nullopt},
        {"after", std::nullopt},      {"Finished", std::nullopt},   {"AFTER", std::nullopt},
        {"finished", Test::Finished}, {"7", std::nullopt},          {"jump7", Test::Fired},
        {"x > 0.5m", std::nullopt},   {"x > 1e999", std::nullopt},  {"x y > 1", std::nullopt},
        {"x =< 1", std::nullopt},     {"", std::nullopt},           {"jump now", std::nullopt},
        {"x > 1 > 2", std::nullopt},  {"finished 1", std::nullopt}, {"x > -.5", Test::Greater},
    };
    for (const auto& [text, test] : cases)
    {
        const Result<StateCondition> parsed = StateCondition::parse(text);
        ASSERT_EQ(static_cast<bool>(parsed), test.has_value()) << text;
        EXPECT_TRUE(!test || parsed.value().test == *test) << text;
        if (test != Test::AtLeast) continue;
        EXPECT_EQ(parsed.value().parameter, "x") << text;
        EXPECT_EQ(parsed.value().value, -0.5) << text;
    }
}

TEST_F(StateMachineTest, aBlendSpaceGetsBothParametersAtOnceAndTheCurveIsThatOfTheTransition)
{
    StateDescription move{"move", ""}, aim{"aim", ""};
    move.blend = StateBlendDescription{{{"Walk", 0, 0}, {"Run", 1, 0}, {"Idle", 0, 1}}, {"x", "y"}};
    aim.blend = StateBlendDescription{{{"Idle", 0}, {"Turn", 1}}, {"angle"}};
    const StateGraphDescription description{
        {move, aim}, {{"move", "aim", {"aim"}, 1.0, FadeCurve::Smooth}, {"aim", "move", {"go"}}}, "", true};
    StateMachine machine = machineOf(description);
    EXPECT_TRUE(machine.set("x", 0.25));
    EXPECT_TRUE(machine.set("y", 0.5));
    EXPECT_TRUE(machine.set("angle", 0.75));
    ASSERT_TRUE(machine.update(controller, 0.1));
    EXPECT_EQ(controller.layer(0).settings().parameter, glm::dvec2(0.25, 0.5)) << "from the first frame on";
    EXPECT_TRUE(controller.layer(0).settings().isPhaseShared);
    EXPECT_TRUE(machine.set("y", 0.25));
    EXPECT_FALSE(machine.update(controller, 0.1));
    EXPECT_EQ(controller.layer(0).settings().parameter, glm::dvec2(0.25, 0.25));
    EXPECT_TRUE(machine.fire("aim"));
    ASSERT_TRUE(machine.update(controller, 0.1));
    EXPECT_EQ(controller.layer(0).settings().parameter, glm::dvec2(0.75, 0.0)) << "of the new state, at once";
    controller.advance(0.25);
    EXPECT_NEAR(controller.layer(0).mixer().fade().value(), 0.15625, 1e-12) << "3x² - 2x³";
    EXPECT_FALSE(machine.update(controller, -5.0));
    EXPECT_EQ(machine.secondsInState(), 0.0) << "negative seconds do not count";
}

TEST_F(StateMachineTest, aPausedClipHasNotFinished)
{
    StateMachine machine = machineOf();
    machine.update(controller, 0.0);
    EXPECT_TRUE(machine.fire("spin"));
    ASSERT_TRUE(machine.update(controller, 0.1));
    controller.pause();
    EXPECT_FALSE(machine.update(controller, 0.1));
    controller.stop();
    EXPECT_FALSE(machine.update(controller, 0.1));
    EXPECT_EQ(machine.state(), "spin");
}

TEST(StateGraphTest, acceptsTheLargestGraph)
{
    const auto set = makeGaitSet();
    StateGraphDescription largest;
    for (std::size_t s = 0; s < StateGraph::maxStates; ++s)
        largest.states.push_back({"s" + std::to_string(s), "Walk"});
    largest.transitions.resize(StateGraph::maxTransitions, {"s0", "s1", {"after 0"}, 0.0});
    EXPECT_TRUE(hasError(StateGraph::create(*set, largest), ""));
    largest.transitions.push_back(largest.transitions.front());
    EXPECT_FALSE(StateGraph::create(*set, largest));
}

} // namespace
} // namespace osgGpuAnimation
