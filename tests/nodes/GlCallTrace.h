// SPDX-License-Identifier: MIT
#pragma once

#include <osg/State>

#include <map>
#include <string>

namespace osgGpuAnimation
{

/// Counts GL calls during its lifetime: calls that stall (glGet*, glFinish, glFlush, read-backs, maps, GL queries,
/// waits), draws, feedback and buffer uploads. This program's functions of the same names replace those that the
/// libraries link to; wrappers replace those that OSG stores as pointers in its GLExtensions.
class GlCallTrace
{
public:
    explicit GlCallTrace(osg::State& state);
    ~GlCallTrace();
    GlCallTrace(const GlCallTrace&) = delete;
    GlCallTrace& operator=(const GlCallTrace&) = delete;

    /// The number of calls by name; functions without a call are left out.
    std::map<std::string, int> calls() const;
    int count(const std::string& name) const;

private:
    osg::GLExtensions* _gl;
};

} // namespace osgGpuAnimation
