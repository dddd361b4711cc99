// SPDX-License-Identifier: MIT
#pragma once

#include "support/Process.h"
#include "support/ScratchFolder.h"
#include "tool/SmallGltf.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A test that runs the tool, in a folder with swingingFlag(); "FLAG" among the arguments is that file.
///
///     using ToolTest = ToolRuns<::testing::Test>;
template <typename Test>
class ToolRuns : public Test
{
protected:
    using Arguments = std::vector<std::string>;

    Process run(Arguments arguments) const
    {
        for (std::string& argument : arguments)
            if (argument == "FLAG") argument = flag;
        return Process::run(OSGGPUANIM, arguments);
    }

    /// Expects success and no message; returns what the tool prints.
    std::string outputOf(const Arguments& arguments) const
    {
        const Process done = run(arguments);
        EXPECT_EQ(done.status, 0) << done.err;
        EXPECT_EQ(done.err, "");
        return done.out;
    }
    nlohmann::json documentOf(const Arguments& arguments) const
    {
        return nlohmann::json::parse(outputOf(arguments), nullptr, false);
    }

    ScratchFolder folder;
    std::string flag = folder.write("flag.gltf", swingingFlag());
};

} // namespace osgGpuAnimation
