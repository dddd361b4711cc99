// SPDX-License-Identifier: MIT
#include "assimp/AssimpFile.h"
#include "assimp/ConversionProcess.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>

using namespace osgGpuAnimation;

namespace
{

/// A signal tells of the limit of time; a second beyond it the kernel kills.
void limit(int resource, rlim_t max)
{
    rlimit both{max, resource == RLIMIT_CPU ? max + 1 : max};
    rlimit current{};
    if (getrlimit(static_cast<__rlimit_resource>(resource), &current) == 0 && current.rlim_max < both.rlim_max)
        both.rlim_cur = both.rlim_max = current.rlim_max;
    setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

bool write(const std::string& bytes, std::FILE* out)
{
    return std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
}

} // namespace

/// Converts a file to GLB for readAsGlbApart(), which starts it. See ConversionProcess.h.
int main(int count, char** arguments)
{
    if (count != 7)
    {
        std::fprintf(stderr, "osggpuanim_assimp converts a file for the plugin osgdb_assimp, which starts it.\n"
                             "To convert a file yourself: osggpuanim convert FILE -o FILE.glb\n");
        return 2;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#ifdef SYS_close_range
    syscall(SYS_close_range, STDERR_FILENO + 1, ~0u, 0); // files and devices of the host
#endif
    std::FILE* const output = fdopen(dup(STDOUT_FILENO), "wb");
    dup2(STDERR_FILENO, STDOUT_FILENO); // what libraries print
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_CPU, std::strtoull(arguments[1], nullptr, 10));
    if (!assimp::reservesAddressSpace) limit(RLIMIT_AS, std::strtoull(arguments[2], nullptr, 10));
    std::set_new_handler([] { _exit(assimp::exitOutOfMemory); });

    gltf::ImportOptions options;
    options.allowOutsideFiles = arguments[3][0] == '1';
    options.maxDecodedBytes = std::strtoull(arguments[4], nullptr, 10);
    options.maxNodeDepth = std::strtoull(arguments[5], nullptr, 10);
    gltf::Messages messages;
    gltf::Report report(messages);
    const Result<std::string> glb = assimp::readAsGlb(arguments[6], options, report);
    nlohmann::json head{{"warnings", messages.warnings}, {"notes", messages.notes}};
    if (glb)
        head["bytes"] = glb.value().size();
    else
        head["error"] = glb.error().message;
    const std::string line = head.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
    const bool isWritten =
        output && write(line, output) && (!glb || write(glb.value(), output)) && std::fflush(output) == 0;
    _exit(isWritten ? 0 : 1); // what the libraries would tidy up belongs to no one
}
