// SPDX-License-Identifier: MIT
#include "gltf/file/ProgressLine.h"

#include <osgGpuAnimation/math/detail/System.h>

#include <chrono>
#include <iostream>
#include <utility>

namespace osgGpuAnimation::gltf
{

ProgressLine::ProgressLine(std::string work)
{
    if (!system::isErrorTerminal()) return;
    _thread = std::thread(&ProgressLine::run, this, std::move(work), _end.get_future());
}

ProgressLine::~ProgressLine()
{
    _end.set_value();
    if (_thread.joinable()) _thread.join();
}

void ProgressLine::run(const std::string& work, const std::future<void>& end)
{
    constexpr std::chrono::milliseconds delay(500), interval(200);
    const char* const clear = "\r\x1b[K"; // to the line's begin; erase to its end
    const auto begin = std::chrono::steady_clock::now();
    if (end.wait_for(delay) == std::future_status::ready) return;
    do
    {
        const auto seconds =
            std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begin).count();
        std::cerr << clear << work << ": ";
        if (_all > 0) std::cerr << _done << " of " << _all << ", ";
        std::cerr << seconds << " s" << std::flush;
    } while (end.wait_for(interval) != std::future_status::ready);
    std::cerr << clear << std::flush;
}

} // namespace osgGpuAnimation::gltf
