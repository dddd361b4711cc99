// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

namespace osgGpuAnimation::gltf
{

/// Says on standard error what a program does if that takes longer than half a second. The end clears the line. If
/// standard error is no terminal, nothing is written.
///
///     ProgressLine progress("drawing");
///     for (...) progress.set(frame, frames);   // drawing: 12 of 100, 3 s
class ProgressLine
{
public:
    explicit ProgressLine(std::string work);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void set(std::size_t done, std::size_t all);

private:
    void run();
    const std::string _work;
    const std::chrono::steady_clock::time_point _begin = std::chrono::steady_clock::now();
    std::mutex _mutex;
    std::condition_variable _change;
    std::size_t _done = 0, _all = 0; ///< 0: the steps are not counted
    bool _isOver = false;
    std::thread _thread; ///< only on a terminal
};

} // namespace osgGpuAnimation::gltf
