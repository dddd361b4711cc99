// SPDX-License-Identifier: MIT
#include "support/PeakMemory.h"
#include "support/Process.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace osgGpuAnimation
{
namespace
{

using nlohmann::json;

const std::string faultyFiles = std::string(OSGGPUANIMATION_SHARED_ASSETS) + "/bad_gltf/";

bool names(const json& entry, const std::string& said)
{
    const std::vector<std::string> patterns = entry["message_any"];
    return std::any_of(patterns.begin(), patterns.end(),
                       [&](const std::string& pattern)
                       { return std::regex_search(said, std::regex(pattern, std::regex::icase)); });
}

/// Expects status 0 or 1, and a message about the element if the entry asks for one.
void expectAnswer(const Process& inspect, const json& entry)
{
    const std::string said = inspect.err + inspect.out;
    ASSERT_TRUE(inspect.status == 0 || inspect.status == 1) << "status " << inspect.status << ": " << said;
    const json accepted = entry.value("accept", json::array({entry["expect"]}));
    const char* const outcome = inspect.status == 1 ? "error" : entry["expect"] == "valid" ? "valid" : "tolerate";
    EXPECT_EQ(std::count(accepted.begin(), accepted.end(), outcome), 1) << outcome << ": " << said;
    EXPECT_TRUE(entry["expect"] == "valid" || entry.value("silent", false) || names(entry, said)) << said;
    EXPECT_LT(inspect.seconds, mostSeconds);
    if (memoryIsMeasurable)
    {
        EXPECT_LT(inspect.peakMebibytes, mostMebibytes);
    }
}

} // namespace

TEST(ToolFaultsTest, inspectAnswersFaultyFilesAsExpected)
{
    std::ifstream list(faultyFiles + "expected.json");
    if (!list) GTEST_SKIP() << "there is no " << faultyFiles << "expected.json";
    const json expected = json::parse(list);
    EXPECT_EQ(expected.size(), 293u);
    for (const auto& [name, entry] : expected.items())
    {
        SCOPED_TRACE(name);
        expectAnswer(Process::run(OSGGPUANIM, {"inspect", faultyFiles + name}), entry);
    }
}

} // namespace osgGpuAnimation
