// SPDX-License-Identifier: MIT
#pragma once

#include "GpuClock.h"

#include <osg/State>

#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// One way to do a step of work.
struct Variant
{
    std::string name;
    std::function<void()> step;
};

/// A page of figures of one device: each line is a variant, compared with the first one of its group.
///
///     page.race("upload", 1000, {{"into the live buffer", …}, {"orphaned", …}}, bytes);
class GpuPage
{
public:
    /// seconds: the time for one variant; the page adapts the number of steps.
    GpuPage(osg::State& state, int rounds, double seconds);

    /// Runs the variants in turns and adds their lines. count: characters. bytes: of memory that a step moves; 0:
    /// unknown.
    void race(const std::string& what, std::size_t count, const std::vector<Variant>& variants, double bytes = 0.0);
    /// Adds the lines of variants that were measured already. series: one for each name.
    void add(const std::string& what, std::size_t count, const std::vector<std::string>& names,
             const std::vector<Series>& series, double bytes = 0.0);

    double copySpeed = 0.0;                         ///< bytes a second, read and written
    std::map<std::string, std::string> environment; ///< names and values

    void print(std::ostream& out) const; ///< Markdown
    /// gpu.md and gpu.json. False: they cannot be written.
    bool write(const std::string& folder) const;

private:
    struct Line
    {
        std::string what;
        std::size_t count;
        std::string variant;
        Figure cpu, wall, gpu; ///< µs a step
        double ratio;          ///< of the deciding times, to the first variant of the group
        double speed;          ///< bytes a second; 0: unknown
    };

    osg::State& _state;
    Figure Line::*_deciding; ///< a software renderer's CPU time, as other programs may run; else the clock
    int _rounds;
    double _seconds;
    std::vector<Line> _lines;
};

} // namespace osgGpuAnimation::benchmark
