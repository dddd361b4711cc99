// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <future>
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

    void set(std::size_t done, std::size_t all)
    {
        _done = done;
        _all = all;
    }

private:
    void run(const std::string& work, const std::future<void>& end);

    std::atomic<std::size_t> _done{0}, _all{0}; ///< 0: the steps are not counted
    std::promise<void> _end;
    std::thread _thread; ///< only on a terminal
};

} // namespace osgGpuAnimation::gltf
