// SPDX-License-Identifier: MIT
#pragma once

#include <osg/State>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Counts GL calls that stall or that cost by the call, while it lives: queries of state (glGet*), glFinish, glFlush,
/// read-backs, maps, GL queries, waits; and draws, feedback, buffer uploads, compiled shaders, linked programs,
/// uniforms and divisors of attributes. The functions that the libraries link to are replaced by this program's own of
/// the same name, those that OSG fetches by pointer in its GLExtensions. At each feedback draw it asks GL for every
/// binding point, since a buffer that feedback writes may have no other.
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
    /// The feedback draws whose bindings were checked.
    int feedbackDraws() const;
    /// Each other binding that a written buffer had at such a draw, "feedback draw 3: texture unit 11".
    const std::vector<std::string>& feedbackConflicts() const;

    /// From here on, compares GL's bindings with osg::State's record (GlBindings) whenever OSG asks GL for errors:
    /// after each attribute that it applies and around each geometry. withFramebuffer: also the draw framebuffer with
    /// the present one, in scenes where OSG binds no other.
    void watchBindings(bool withFramebuffer);
    /// What differed, each difference once.
    const std::set<std::string>& bindingDifferences() const;
    int bindingChecks() const; ///< since watchBindings()

private:
    osg::State& _state;
    osg::GLExtensions* _gl;
    osg::State::CheckForGLErrors _errorChecks;
};

} // namespace osgGpuAnimation
