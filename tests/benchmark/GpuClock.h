// SPDX-License-Identifier: MIT
#pragma once

#include "Report.h"

#include <osg/GLExtensions>
#include <osg/State>

#include <vector>

namespace osgGpuAnimation::benchmark
{

/// The GPU time of stretches of a context's work, by time stamps that nothing waits for. The context must be current.
class GpuClock
{
public:
    explicit GpuClock(osg::State& state);
    ~GpuClock();
    GpuClock(const GpuClock&) = delete;
    GpuClock& operator=(const GpuClock&) = delete;

    /// False: the driver has no time stamps, or is a software renderer, whose time stamps say nothing of feedback: the
    /// calling thread computes it.
    bool isThere() const { return _bits > 0; }
    void begin() { stamp(); }
    void end() { stamp(); }
    /// The sum in seconds since the last call; 0 without time stamps. Waits for the GPU.
    double take();

private:
    void stamp();

    osg::GLExtensions& _gl;
    GLint _bits;
    std::vector<GLuint> _queries; ///< of all stamps so far, in turns begin and end
    std::vector<GLuint> _spare;
};

/// The cost of one of `count` steps that follow each other without waiting, from an idle GPU until it has finished.
template <typename Step>
Spent inARow(std::size_t count, GpuClock& clock, const Step& step)
{
    glFinish();
    const Stopwatch stopwatch;
    clock.begin();
    for (std::size_t i = 0; i < count; ++i)
        step();
    clock.end();
    glFinish();
    return stopwatch.elapsed().with(clock.take()) / static_cast<double>(count);
}

} // namespace osgGpuAnimation::benchmark
