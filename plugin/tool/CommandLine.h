// SPDX-License-Identifier: MIT
#pragma once

#include "tool/ConvertCommand.h"
#include "tool/InspectCommand.h"
#include "tool/PoseCommand.h"
#include "tool/RenderCommand.h"

#include <CLI/App.hpp>

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
    void addInspect();
    void addPose();
    void addRender();
    void addConvert();
    Result<void> runCommand() const;

    CLI::App _app;
    CLI::App* _inspectApp = nullptr;
    CLI::App* _poseApp = nullptr;
    CLI::App* _renderApp = nullptr;
    CLI::App* _convertApp = nullptr;
    InspectCommand _inspect;
    PoseCommand _pose;
    RenderCommand _render;
    ConvertCommand _convert;
};

} // namespace osgGpuAnimation::tool
