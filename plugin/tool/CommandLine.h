// SPDX-License-Identifier: MIT
#pragma once

#include "tool/ConvertCommand.h"
#include "tool/InspectCommand.h"
#include "tool/PoseCommand.h"
#include "tool/RenderCommand.h"

#include <CLI/App.hpp>

#include <functional>
#include <string>

namespace osgGpuAnimation::tool
{

/// The command line of osggpuanim: its commands, their options and their help.
class CommandLine
{
public:
    CommandLine();

    /// Runs the command of the arguments. Exit status: 0 success, 1 a file is at fault, 2 wrong usage.
    int run(int argc, char** argv);

private:
    /// A command with what all have: a help, FILE, --clips and --clip-joints.
    template <typename Command>
    CLI::App& addCommand(const char* name, const char* purpose, const std::string& help, const std::string& file,
                         Command& command);
    void addInspect();
    void addPose();
    void addRender();
    void addConvert();

    CLI::App _app;
    std::function<Result<void>()> _run; ///< the command that was parsed
    InspectCommand _inspect;
    PoseCommand _pose;
    RenderCommand _render;
    ConvertCommand _convert;
};

} // namespace osgGpuAnimation::tool
