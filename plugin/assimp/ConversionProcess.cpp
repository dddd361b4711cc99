// SPDX-License-Identifier: MIT
#include "assimp/ConversionProcess.h"

#include <osgGpuAnimation/math/detail/System.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace osgGpuAnimation::assimp
{

namespace
{

using Clock = std::chrono::steady_clock;

const char* const helperName = "osggpuanim_assimp";

/// Two connected descriptors, which close themselves and which no other child inherits.
struct Pipe
{
    int ends[2] = {-1, -1};

    Pipe()
    {
        if (pipe2(ends, O_CLOEXEC) != 0) ends[0] = ends[1] = -1;
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe()
    {
        close(0);
        close(1);
    }

    bool isOpen(int end) const { return ends[end] >= 0; }
    void close(int end)
    {
        if (isOpen(end)) ::close(ends[end]);
        ends[end] = -1;
    }
};

/// A started helper. It is killed and waited for if its end was not seen.
class Child
{
public:
    Child(const std::string& program, const std::vector<std::string>& arguments, const Pipe& output, const Pipe& errors)
    {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, errors.ends[1], STDERR_FILENO);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &all);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        std::vector<char*> pointers{const_cast<char*>(program.c_str())};
        for (const std::string& argument : arguments)
            pointers.push_back(const_cast<char*>(argument.c_str()));
        pointers.push_back(nullptr);
        _failure = posix_spawn(&_process, program.c_str(), &actions, &attributes, pointers.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&actions);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child()
    {
        if (_failure == 0 && !_isReaped)
        {
            ::kill(_process, SIGKILL);
            reap(0);
        }
    }

    int failure() const { return _failure; } ///< errno of the start; 0: it runs
    /// Waits for the end of the helper; false: it runs on at that time.
    bool hasEndedBy(Clock::time_point latest)
    {
        auto pause = std::chrono::microseconds(100);
        constexpr auto maxPause = std::chrono::microseconds(10000);
        while (!reap(WNOHANG))
        {
            if (Clock::now() >= latest) return false;
            std::this_thread::sleep_for(pause);
            pause = std::min(2 * pause, maxPause);
        }
        return true;
    }
    /// The status of waitpid(), after the end; none where the host reaps or ignores its children.
    const std::optional<int>& status() const { return _status; }

private:
    bool reap(int options)
    {
        int status = 0;
        pid_t ended = 0;
        do
            ended = waitpid(_process, &status, options);
        while (ended < 0 && errno == EINTR);
        if (ended == 0) return false;
        if (ended == _process) _status = status;
        _isReaped = true;
        return true;
    }

    pid_t _process = -1;
    int _failure = 0;
    bool _isReaped = false;
    std::optional<int> _status;
};

/// What a helper has written, until it closed both ends or reached a limit.
struct Written
{
    std::string output, errors;
    bool isLate = false, isTooLarge = false;
};

Written readAll(Pipe& output, Pipe& errors, std::size_t maxOutputBytes, Clock::time_point end)
{
    constexpr std::size_t maxErrorBytes = 1 << 16;
    Written written;
    std::vector<char> buffer(1 << 16);
    while (output.isOpen(0) || errors.isOpen(0))
    {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        written.isLate = left <= 0;
        if (written.isLate) break;
        pollfd waited[2] = {{output.ends[0], POLLIN, 0}, {errors.ends[0], POLLIN, 0}};
        if (poll(waited, 2, static_cast<int>(std::min<long long>(left, 1 << 30))) <= 0) continue;
        for (int i = 0; i < 2; ++i)
        {
            Pipe& pipe = i == 0 ? output : errors;
            if (waited[i].revents == 0) continue;
            const ssize_t count = read(pipe.ends[0], buffer.data(), buffer.size());
            if (count > 0)
                (i == 0 ? written.output : written.errors).append(buffer.data(), static_cast<std::size_t>(count));
            else if (count == 0 || errno != EINTR)
                pipe.close(0);
        }
        if (written.errors.size() > maxErrorBytes) written.errors.erase(0, written.errors.size() - maxErrorBytes / 2);
        written.isTooLarge = written.output.size() > maxOutputBytes;
        if (written.isTooLarge) break;
    }
    return written;
}

std::string lastLine(std::string text)
{
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r'))
        text.pop_back();
    return gltf::printable(text.substr(text.rfind('\n') + 1), 300);
}

std::string megabytes(std::size_t bytes)
{
    return std::to_string(bytes >> 20) + " MiB";
}

Error endedBy(int signal, const std::string& printed)
{
    const std::string said = lastLine(printed);
    return {"Assimp ended with signal " + std::to_string(signal) + " (" + strsignal(signal) +
            ") while it read the file" + (said.empty() ? "" : ": " + said) +
            "; the file is damaged, or has what this version of Assimp cannot read: write it again, or as glTF"};
}

/// The GLB or the error that the helper has written; none: it is not complete.
std::optional<Result<std::string>> unpacked(std::string& output, gltf::Report& report)
{
    constexpr std::size_t maxHeadBytes = 1 << 20; // a report has few messages
    const std::size_t end = output.find('\n');
    if (end > maxHeadBytes) return std::nullopt; // or there is no line
    try
    {
        const nlohmann::json head = nlohmann::json::parse(output.data(), output.data() + end);
        for (const std::string& warning : head.at("warnings").get<std::vector<std::string>>())
            report.warn(warning);
        for (const std::string& note : head.at("notes").get<std::vector<std::string>>())
            report.note(note);
        if (head.contains("error")) return Result<std::string>(Error{head["error"].get<std::string>()});
        output.erase(0, end + 1);
        if (output.size() == head.at("bytes").get<std::size_t>()) return Result<std::string>(std::move(output));
    }
    catch (const nlohmann::json::exception&)
    {
        // A program that a faulty file took over may write anything.
    }
    return std::nullopt;
}

std::filesystem::path folderOfThisModule()
{
    std::error_code failure;
    const std::string path = system::moduleOf(reinterpret_cast<const void*>(&folderOfThisModule));
    std::filesystem::path module = std::filesystem::canonical(path, failure);
    // A program may have been started by a name that is no path.
    if (module.empty() || failure) module = std::filesystem::canonical("/proc/self/exe", failure);
    return module.parent_path();
}

} // namespace

ConversionHelper ConversionHelper::installed()
{
    ConversionHelper helper;
    const std::filesystem::path folder = folderOfThisModule();
    for (const std::filesystem::path& place :
         {folder, folder / OSGGPUANIMATION_PLUGINS_OF_BUILD, folder / OSGGPUANIMATION_PLUGINS_OF_INSTALLATION})
        if (access((place / helperName).c_str(), X_OK) == 0 && helper.program.empty())
            helper.program = (place / helperName).string();
    return helper;
}

Result<std::string> readAsGlbApart(const std::string& fileName, const gltf::ImportOptions& options,
                                   gltf::Report& report)
{
    return readAsGlbWith(ConversionHelper::installed(), fileName, options, report);
}

Result<std::string> readAsGlbWith(const ConversionHelper& helper, const std::string& fileName,
                                  const gltf::ImportOptions& options, gltf::Report& report)
{
    if (helper.program.empty())
        return Error{std::string("the program ") + helperName +
                     ", which converts the files that Assimp reads, is missing: install it beside osgdb_assimp.so"};
    std::error_code noSize;
    const std::uintmax_t fileBytes = std::filesystem::file_size(fileName, noSize);
    constexpr std::size_t memoryForEachByte = 16;
    const std::size_t memory =
        helper.memoryBytes + memoryForEachByte * (noSize ? 0 : static_cast<std::size_t>(fileBytes));
    Pipe output, errors;
    if (!output.isOpen(0) || !errors.isOpen(0))
        return Error{"no pipe to the program that converts it: " + std::string(std::strerror(errno))};
    const auto end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(helper.seconds));
    Child child(helper.program,
                {std::to_string(static_cast<long>(helper.seconds) + 1), std::to_string(memory),
                 options.allowOutsideFiles ? "1" : "0", std::to_string(options.maxDecodedBytes),
                 std::to_string(options.maxNodeDepth), fileName},
                output, errors);
    if (child.failure() != 0)
        return Error{helper.program + ", which converts the files that Assimp reads, cannot be started: " +
                     std::strerror(child.failure())};
    output.close(1);
    errors.close(1);
    Written written = readAll(output, errors, helper.maxOutputBytes, end);
    const Error late{"Assimp was stopped: it had not read the file after " + gltf::numberText(helper.seconds) +
                     " seconds"};
    if (written.isLate || (!written.isTooLarge && !child.hasEndedBy(end))) return late;
    if (written.isTooLarge)
        return Error{"Assimp was stopped: it made more than " + megabytes(helper.maxOutputBytes) + " of the file"};
    const std::optional<int>& status = child.status();
    if (status && WIFSIGNALED(*status))
        return WTERMSIG(*status) == SIGXCPU ? late : endedBy(WTERMSIG(*status), written.errors);
    if (status && WIFEXITED(*status) && WEXITSTATUS(*status) == exitOutOfMemory)
        return Error{"Assimp was stopped: the file needs more than " + megabytes(memory) + " of memory"};
    if (std::optional<Result<std::string>> result = unpacked(written.output, report)) return *std::move(result);
    const std::string said = lastLine(written.errors);
    return Error{helper.program + " ended without a result" + (said.empty() ? "" : ": " + said)};
}

} // namespace osgGpuAnimation::assimp
