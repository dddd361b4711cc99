// SPDX-License-Identifier: MIT
#include "gltf/file/ProgressLine.h"

#include <osgGpuAnimation/math/detail/System.h>

#include <iostream>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::chrono::milliseconds delay(500), interval(200);
const char* const clear = "\r\x1b[K"; // to the line's begin; erase to its end

} // namespace

ProgressLine::ProgressLine(std::string work) : _work(std::move(work))
{
    if (system::isErrorTerminal()) _thread = std::thread(&ProgressLine::run, this);
}

ProgressLine::~ProgressLine()
{
    if (!_thread.joinable()) return;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _isOver = true;
    }
    _change.notify_one();
    _thread.join();
}

void ProgressLine::set(std::size_t done, std::size_t all)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _done = done;
    _all = all;
}

void ProgressLine::run()
{
    std::unique_lock<std::mutex> lock(_mutex);
    const auto isOver = [this] { return _isOver; };
    if (_change.wait_for(lock, delay, isOver)) return;
    do
    {
        const auto seconds =
            std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - _begin).count();
        std::cerr << clear << _work << ": ";
        if (_all > 0) std::cerr << _done << " of " << _all << ", ";
        std::cerr << seconds << " s" << std::flush;
    } while (!_change.wait_for(lock, interval, isOver));
    std::cerr << clear << std::flush;
}
} // namespace osgGpuAnimation::gltf
