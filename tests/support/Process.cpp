// SPDX-License-Identifier: MIT
#include "support/Process.h"

#include <array>
#include <cstdio>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace osgGpuAnimation
{

namespace
{

/// An unnamed file, deleted with the object.
class ScratchFile
{
public:
    ScratchFile() : _file(std::tmpfile()) {}
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    ~ScratchFile()
    {
        if (_file) std::fclose(_file);
    }

    int descriptor() const { return _file ? fileno(_file) : -1; }
    std::string content() const
    {
        std::string text;
        std::array<char, 4096> part{};
        off_t offset = 0;
        for (ssize_t size = 0; (size = pread(descriptor(), part.data(), part.size(), offset)) > 0; offset += size)
            text.append(part.data(), static_cast<std::size_t>(size));
        return text;
    }

private:
    std::FILE* _file;
};

double secondsOf(const timeval& time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

} // namespace

Process Process::run(const std::string& program, const std::vector<std::string>& arguments)
{
    const ScratchFile out;
    const ScratchFile err;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err.descriptor(), STDERR_FILENO);

    std::vector<char*> words{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments)
        words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);

    Process process;
    pid_t child = 0;
    const int failure = posix_spawnp(&child, program.c_str(), &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    int state = 0;
    rusage usage{};
    if (failure == 0 && wait4(child, &state, 0, &usage) == child)
        process.status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    process.seconds = secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime);
    process.peakMebibytes = usage.ru_maxrss / 1024;
    process.out = out.content();
    process.err = err.content();
    return process;
}

} // namespace osgGpuAnimation
