// SPDX-License-Identifier: MIT
#include "support/Process.h"
#include "support/ScratchFolder.h"
#include "tool/SmallGltf.h"

#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

namespace osgGpuAnimation
{

namespace
{

/// What the program writes to its terminal.
std::string terminalOf(const std::vector<std::string>& arguments)
{
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0)
    {
        std::vector<char*> words;
        for (const std::string& argument : arguments)
            words.push_back(const_cast<char*>(argument.c_str()));
        words.push_back(nullptr);
        execv(words.front(), words.data());
        _exit(127);
    }
    // It works for 0.1 s at a time and then stands still, so that the work takes long on a fast machine, too.
    int status = -1;
    while (waitpid(child, &status, WNOHANG) == 0)
    {
        usleep(100000);
        kill(child, SIGSTOP);
        usleep(600000);
        kill(child, SIGCONT);
    }
    std::string written;
    char bytes[4096];
    for (ssize_t count; (count = read(terminal, bytes, sizeof bytes)) > 0;)
        written.append(bytes, static_cast<std::size_t>(count));
    close(terminal);
    EXPECT_EQ(status, 0) << written;
    return written;
}

/// 30,000 poses in a file: more than a tenth of a second of work.
std::vector<std::string> longWork(const ScratchFolder& folder)
{
    std::vector<std::string> arguments{
        OSGGPUANIM,    "pose", folder.write("flag.gltf", swingingFlag()), "-o", folder.file("poses.json"),
        "--evaluator", "cpu"};
    for (int time = 0; time < 30000; ++time)
        arguments.insert(arguments.end(), {"--time", std::to_string(0.0001 * time)});
    return arguments;
}

TEST(ProgressTest, longWorkShowsALineOnATerminalAndClearsIt)
{
    const ScratchFolder folder;
    const std::string written = terminalOf(longWork(folder));
    EXPECT_NE(written.find("computing poses: "), std::string::npos) << written;
    EXPECT_NE(written.find(" of 30000, "), std::string::npos) << written;
    const std::string clear = "\r\x1b[K";
    ASSERT_GE(written.size(), clear.size());
    EXPECT_EQ(written.substr(written.size() - clear.size()), clear);
}

TEST(ProgressTest, withoutATerminalLongWorkShowsNothing)
{
    const ScratchFolder folder;
    std::vector<std::string> arguments = longWork(folder);
    arguments.erase(arguments.begin());
    const Process done = Process::run(OSGGPUANIM, arguments);
    EXPECT_EQ(done.status, 0);
    EXPECT_EQ(done.err + done.out, "");
}

} // namespace

} // namespace osgGpuAnimation
