// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/StateGraphFile.h>

#include "support/GaitSet.h"
#include "support/Results.h"
#include "support/ScratchFolder.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

namespace
{

constexpr char text[] = R"({
    "start": "walk",
    "states": {
        "stand": { "clip": "Idle" },
        "walk": { "clip": "Walk", "speed": 1.5 },
        "spin": { "clip": "Turn", "loop": "once" },
        "sway": { "clip": "Turn", "loop": "pingpong" }
    },
    "transitions": [
        { "from": "stand", "to": "walk", "when": ["speed > 0.1", "after 0.5"], "seconds": 0.3, "sync": "phase" },
        { "to": "spin", "when": "spin", "curve": "smooth" },
        { "from": "spin", "to": "stand", "when": ["finished"], "curve": "linear", "sync": "start" }
    ]
})";

TEST(StateGraphFileTest, readsAllThatAGraphHas)
{
    const auto set = makeGaitSet();
    const auto made = valueOf(parseStateGraph(*set, text));
    const StateGraph& graph = *made;
    ASSERT_EQ(graph.states().size(), 4u);
    EXPECT_EQ(graph.states()[graph.start()].name, "walk");
    EXPECT_EQ(graph.states()[1].speed, 1.5);
    EXPECT_EQ(graph.states()[1].loopMode, LoopMode::Loop);
    EXPECT_EQ(graph.states()[2].loopMode, LoopMode::Once);
    EXPECT_EQ(graph.states()[3].loopMode, LoopMode::PingPong);
    ASSERT_EQ(graph.transitions().size(), 3u);
    EXPECT_EQ(graph.transitions()[0].conditions.size(), 2u);
    EXPECT_EQ(graph.transitions()[0].seconds, 0.3);
    EXPECT_EQ(graph.transitions()[0].options.sync, Sync::Phase);
    EXPECT_EQ(graph.transitions()[1].from, std::nullopt);
    EXPECT_EQ(graph.transitions()[1].options.curve, FadeCurve::Smooth);
    EXPECT_EQ(graph.transitions()[2].from, 2);
    EXPECT_EQ(graph.transitions()[2].to, 0);
    EXPECT_EQ(graph.transitions()[2].options.curve, FadeCurve::Linear);
    EXPECT_EQ(graph.transitions()[2].options.sync, Sync::Start);
    EXPECT_EQ(graph.parameters(), std::vector<std::string>{"speed"});
    EXPECT_EQ(graph.triggers(), std::vector<std::string>{"spin"});
}

TEST(StateGraphFileTest, aStateMayPlayABlendSpace)
{
    const auto gait = makeGaitSet();
    std::vector<Clip> clips = gait->clips();
    for (Clip& clip : clips)
        clip = clip.withMarkers({{0.1, "left"}, {0.4, "right"}}).value();
    const auto set = gait->withClips(clips).value();
    const auto graph = valueOf(parseStateGraph(*set, R"({
        "sharedPhase": true,
        "states": {
            "stand": { "clip": "Idle" },
            "move": { "blend": [{ "clip": "Walk", "at": 1.5 }, { "clip": "Run", "at": 4 }], "parameter": "speed" },
            "strafe": { "blend": [{ "clip": "Walk", "at": [1, -2] }, { "clip": "Run", "at": [4, 3] }],
                        "parameter": ["speed", "side"], "speed": 0.5, "markers": ["left", "right"] }
        },
        "transitions": [
            { "from": "stand", "to": "move", "when": "speed > 0.1" },
            { "from": "move", "to": "strafe", "when": "strafe" }
        ]
    })"));
    EXPECT_EQ(graph->parameters(), (std::vector<std::string>{"speed", "side"}));
    const BlendSpace& space = *graph->states()[2].space;
    EXPECT_EQ(space.syncMarkers(), (std::vector<std::string>{"left", "right"}));
    EXPECT_EQ(space.points()[0].place, glm::dvec2(1, -2));
    EXPECT_EQ(space.points()[1].place, glm::dvec2(4, 3));
    AnimationController controller(set);
    StateMachine machine(graph);
    const auto step = [&](double speed)
    {
        EXPECT_TRUE(machine.set("speed", speed));
        for (int i = 0; i < 4; ++i) // more than a fade
        {
            machine.update(controller, 0.1);
            controller.advance(0.1);
        }
        return machine.state();
    };
    EXPECT_EQ(step(0.0), "stand");
    EXPECT_TRUE(controller.layer(0).settings().isPhaseShared);
    EXPECT_FALSE(controller.layer(0).mixer().currentSpace());
    EXPECT_EQ(step(2.75), "move");
    ASSERT_EQ(controller.instruction().sampleCount, 2u);
    EXPECT_FLOAT_EQ(controller.instruction().samples[0].weight, 0.5f) << "the parameter passes to the space";
    EXPECT_TRUE(machine.fire("strafe"));
    EXPECT_TRUE(machine.set("side", 0.5));
    EXPECT_EQ(step(0.75), "strafe");
    EXPECT_EQ(controller.layer(0).settings().parameter, glm::dvec2(0.75, 0.5));
    EXPECT_EQ(controller.layer(0).settings().speed, 0.5);
}

TEST(StateGraphFileTest, theSpeedMayFollowTheGround)
{
    const auto set = makeStridingSet({{"Walk", 1.0, 1.2, 0.62}, {"Run", 0.6, 3.2, 0.36}});
    const auto graph = valueOf(parseStateGraph(*set, R"({
        "states": {
            "walk": { "clip": "Walk", "groundSpeed": "speed" },
            "move": { "blend": [{ "clip": "Walk", "at": 1.2 }, { "clip": "Run", "at": 3.2 }], "parameter": "speed",
                      "groundSpeed": "speed" }
        },
        "transitions": [{ "from": "walk", "to": "move", "when": "speed > 1.5" }]
    })"));
    AnimationController controller(set);
    StateMachine machine(graph);
    EXPECT_TRUE(machine.set("speed", 0.6));
    machine.update(controller, 0.1);
    EXPECT_NEAR(controller.layer(0).settings().speed, 0.5, 0.005);
    EXPECT_TRUE(machine.set("speed", 3.2));
    machine.update(controller, 0.1);
    EXPECT_EQ(machine.state(), "move");
    EXPECT_NEAR(controller.layer(0).settings().speed, 1.0, 0.01) << "a run at its own speed";
    EXPECT_TRUE(machine.set("speed", 6.4));
    machine.update(controller, 0.1);
    EXPECT_NEAR(controller.layer(0).settings().speed, 2.0, 0.02) << "beyond the fastest clip";
}

TEST(StateGraphFileTest, faultsAreNamed)
{
    struct Case
    {
        const char* json;
        const char* message;
    };
    const Case cases[] = {
        {"", "JSON syntax: parse error at line 1, column 1"},
        {"{", "JSON syntax: parse error at line 1, column 2"},
        {R"({"states": {"a": {"clip": "Walk", "speed": 1e999}}})", "JSON syntax: "},
        {"[]", "the file: expected an object, found array"},
        {"{}", "a state graph without states"},
        {R"({"states": []})", "states: expected an object, found array"},
        {R"({"states": {"a": 1}})", "states.a: expected an object, found number"},
        {R"({"states": {"a": {"clip": 1}}})", "states.a.clip: expected a string, found number"},
        {R"({"states": {"a": {}}})", "states.a: it has no \"clip\""},
        {R"({"states": {"a": {"clip": "Walk", "loop": "twice"}}})",
         "states.a.loop: \"twice\" is not one of \"loop\", \"once\", \"pingpong\""},
        {R"({"states": {"a": {"clip": "Walk", "sped": 1}}})", "states.a: unknown member \"sped\""},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": {}})", "transitions: expected an array, found object"},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [7]})",
         "transitions[0]: expected an object, found number"},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [{"to": "b", "when": "x"}]})",
         "transition 0: there is no state \"b\"; the states are \"a\""},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [{"when": "x"}]})", "transitions[0]: it has no \"to\""},
        {R"({"states": {"a": {"clip": "Walk"}, "a": {"clip": "Run"}}})", "member \"a\" comes twice"},
        {R"({"states": {"a": {"clip": "Walk", "clip": "Run"}}})", "member \"clip\" comes twice"},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [{"to": "a", "when": [1]}]})",
         "transitions[0].when: expected a string, found number"},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [{"to": "a", "when": "x", "seconds": "1"}]})",
         "transitions[0].seconds: expected a number, found string"},
        {R"({"states": {"a": {"clip": "Walk", "groundSpeed": 1}}})",
         "states.a.groundSpeed: expected a string, found number"},
        {R"({"states": {"a": {"clip": "Walk", "groundSpeed": "a b"}}})",
         "state \"a\": \"a b\" is not the name of a parameter"},
        {R"({"sharedPhase": 1, "states": {"a": {"clip": "Walk"}}})",
         "sharedPhase: expected true or false, found number"},
        {R"({"states": {"a": {"blend": []}}})", "states.a: it has no \"parameter\""},
        {R"({"states": {"a": {"blend": [], "parameter": "x"}}})", "state \"a\": a blend space of 0 positions"},
        {R"({"states": {"a": {"blend": {}, "parameter": "x"}}})", "states.a.blend: expected an array, found object"},
        {R"({"states": {"a": {"blend": [{"clip": "Walk"}], "parameter": "x"}}})",
         "states.a.blend[0]: it has no \"at\""},
        {R"({"states": {"a": {"blend": [{"clip": "Walk", "at": "1"}], "parameter": "x"}}})",
         "states.a.blend[0].at: expected a number or an array of two numbers, found string"},
        {R"({"states": {"a": {"blend": [{"clip": "Fly", "at": 1}], "parameter": "x"}}})",
         "state \"a\": a blend space: there is no clip \"Fly\""},
        {R"({"states": {"a": {"blend": [{"clip": "Walk", "at": 1}], "parameter": ["x", "y", "z"]}}})",
         "state \"a\": a blend space with 3 parameters: expected one or two"},
        {R"({"states": {"a": {"blend": [{"clip": "Walk", "at": 1}], "parameter": "x > y"}}})",
         "state \"a\": \"x > y\" is not the name of a parameter"},
        {R"({"states": {"a": {"blend": [{"clip": "Walk", "at": 1}], "parameter": "x", "clip": "Walk"}}})",
         "states.a: unknown member \"clip\""},
        {R"({"states": {"a": {"clip": "Walk"}}, "start": "b"})", "start: there is no state \"b\""},
    };
    const auto set = makeGaitSet();
    for (const Case& c : cases)
    {
        const auto graph = parseStateGraph(*set, c.json);
        EXPECT_TRUE(hasError(graph, c.message)) << c.json;
        EXPECT_EQ(errorOf(graph).find("json.exception"), std::string::npos) << errorOf(graph);
    }
}

TEST(StateGraphFileTest, deepAndLongTextsAreErrorsLikeAnyOther)
{
    const auto set = makeGaitSet();
    const auto nested = [](std::size_t depth)
    { return "{\"states\":{\"a\":" + std::string(depth, '[') + std::string(depth, ']') + "}}"; };
    const std::pair<std::string, const char*> cases[] = {
        {nested(200), "states.a: expected an object, found array"},
        {nested(300), "nested more than 256 deep"},
        {nested(30000), "nested more than 256 deep"},
        {std::string(60000, '['), "nested more than 256 deep"},
        {"{\"states\":{\"a\":{\"clip\":\"Walk\"}}}" + std::string(1 << 16, ' '), "bytes, at most 65536 are read"}};
    for (const auto& [json, message] : cases)
    {
        EXPECT_TRUE(hasError(parseStateGraph(*set, json), message));
    }
}

TEST(StateGraphFileTest, readsFilesAndNamesThemInErrors)
{
    const auto set = makeGaitSet();
    const ScratchFolder folder;
    EXPECT_TRUE(readStateGraphFile(*set, folder.write("good.states.json", text)));
    const std::string longest = text + std::string((1 << 16) - std::string(text).size(), ' ');
    EXPECT_TRUE(parseStateGraph(*set, longest));
    EXPECT_TRUE(readStateGraphFile(*set, folder.write("longest.states.json", longest)));
    EXPECT_EQ(readStateGraphFile(*set, "/dev/null").error().message,
              "/dev/null: expected a regular file, found a device or socket");
    const auto fault = [&](const std::string& file) { return readStateGraphFile(*set, file).error().message; };
    const std::string bad = folder.write("bad.states.json", "{}");
    EXPECT_EQ(fault(bad), bad + ": a state graph without states");
    const std::string none = folder.file("none.json");
    EXPECT_EQ(fault(none), none + ": the file does not exist");
    EXPECT_EQ(fault(folder.file("")), folder.file("") + ": expected a regular file, found a folder");
    const std::string huge = folder.write("huge.json", std::string((1 << 16) + 1, ' '));
    EXPECT_EQ(fault(huge), huge + ": expected a file of at most 65536 bytes, found 65537");
}

} // namespace

} // namespace osgGpuAnimation
