// SPDX-License-Identifier: MIT
#pragma once

#include <osg/State>

#include <map>
#include <string>

namespace osgGpuAnimation
{

/// Counts GL calls that stall or that cost by the call, while it lives: queries of state (glGet*), glFinish, glFlush,
/// read-backs, maps, GL queries, waits; and draws, feedback and buffer uploads. The functions that the libraries link
/// to are replaced by this program's own of the same name, those that OSG fetches by pointer in its GLExtensions.
class GlCallTrace
{
public:
    explicit GlCallTrace(osg::State& state);
    ~GlCallTrace();
    GlCallTrace(const GlCallTrace&) = delete;
    GlCallTrace& operator=(const GlCallTrace&) = delete;

    /// Calls by name, those not called left out.
    std::map<std::string, int> calls() const;
    int count(const std::string& name) const;

private:
    osg::GLExtensions* _gl;
};

} // namespace osgGpuAnimation
