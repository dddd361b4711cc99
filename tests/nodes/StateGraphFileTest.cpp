// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/StateGraphFile.h>

#include "support/GaitSet.h"
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
        "spin": { "clip": "Turn", "loop": "once" }
    },
    "transitions": [
        { "from": "stand", "to": "walk", "when": ["speed > 0.1", "after 0.5"], "seconds": 0.3, "sync": "phase" },
        { "to": "spin", "when": "spin", "curve": "smooth" },
        { "from": "spin", "to": "stand", "when": ["finished"] }
    ]
})";

TEST(StateGraphFileTest, ReadsAllThatAGraphHas)
{
    const auto set = makeGaitSet();
    const auto result = parseStateGraph(*set, text);
    ASSERT_TRUE(result) << result.error().message;
    const StateGraph& graph = *result.value();
    ASSERT_EQ(graph.states().size(), 3u);
    EXPECT_EQ(graph.states()[graph.start()].name, "walk");
    EXPECT_EQ(graph.states()[1].speed, 1.5);
    EXPECT_EQ(graph.states()[2].loopMode, LoopMode::Once);
    ASSERT_EQ(graph.transitions().size(), 3u);
    EXPECT_EQ(graph.transitions()[0].conditions.size(), 2u);
    EXPECT_EQ(graph.transitions()[0].seconds, 0.3);
    EXPECT_EQ(graph.transitions()[0].options.sync, Sync::Phase);
    EXPECT_EQ(graph.transitions()[1].from, -1);
    EXPECT_EQ(graph.transitions()[1].options.curve, FadeCurve::Smooth);
    EXPECT_EQ(graph.parameters(), std::vector<std::string>{"speed"});
    EXPECT_EQ(graph.triggers(), std::vector<std::string>{"spin"});
}

TEST(StateGraphFileTest, FaultsAreNamed)
{
    struct Case
    {
        const char* json;
        const char* message;
    };
    const Case cases[] = {
        {"", "parse error"},
        {"{", "parse error"},
        {"[]", "the file: expected an object, found array"},
        {"{}", "a state graph without states"},
        {R"({"states": []})", "states: expected an object, found array"},
        {R"({"states": {"a": 1}})", "states.a: expected an object, found number"},
        {R"({"states": {"a": {"clip": 1}}})", "states.a.clip: expected a string, found number"},
        {R"({"states": {"a": {}}})", "state \"a\": there is no clip \"\""},
        {R"({"states": {"a": {"clip": "Walk", "loop": "twice"}}})",
         "states.a.loop: \"twice\" is not one of \"loop\", \"once\", \"pingpong\""},
        {R"({"states": {"a": {"clip": "Walk", "sped": 1}}})", "states.a: unknown member \"sped\""},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": {}})", "transitions: expected an array, found object"},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [7]})",
         "transitions[0]: expected an object, found number"},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [{"to": "b", "when": "x"}]})",
         "transition 0: there is no state \"b\""},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [{"to": "a", "when": [1]}]})",
         "transitions[0].when: expected a string, found number"},
        {R"({"states": {"a": {"clip": "Walk"}}, "transitions": [{"to": "a", "when": "x", "seconds": "1"}]})",
         "transitions[0].seconds: expected a number, found string"},
        {R"({"states": {"a": {"clip": "Walk"}}, "start": "b"})", "start: there is no state \"b\""},
    };
    const auto set = makeGaitSet();
    for (const Case& c : cases)
    {
        const auto graph = parseStateGraph(*set, c.json);
        ASSERT_FALSE(graph) << c.json;
        EXPECT_NE(graph.error().message.find(c.message), std::string::npos) << graph.error().message;
    }
    EXPECT_FALSE(parseStateGraph(*set, std::string(1 << 20, '['))) << "deep nesting is an error like any other";
}

TEST(StateGraphFileTest, ReadsFilesAndNamesThemInErrors)
{
    const auto set = makeGaitSet();
    const ScratchFolder folder;
    EXPECT_TRUE(readStateGraphFile(*set, folder.write("good.states.json", text)));
    const std::string bad = folder.write("bad.states.json", "{}");
    const auto faulty = readStateGraphFile(*set, bad);
    ASSERT_FALSE(faulty);
    EXPECT_EQ(faulty.error().message, bad + ": a state graph without states");
    EXPECT_FALSE(readStateGraphFile(*set, folder.file("none.json")));
    EXPECT_FALSE(readStateGraphFile(*set, folder.file("")));
    EXPECT_FALSE(readStateGraphFile(*set, folder.write("huge.json", std::string((1 << 20) + 1, ' '))));
}

} // namespace

} // namespace osgGpuAnimation
