// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>
#include <osg/GLObjects>
#include <osg/Referenced>
#include <osg/State>

#include <deque>
#include <vector>

namespace osgGpuAnimation
{

/// OSG's lists of the programs, shaders and vertex array objects to delete in a context. OSG creates each list when the
/// first object is deleted, in any thread (a DatabasePager that deletes its last character) and without a lock, while
/// the draw thread may read the lists. Lists that exist beforehand avoid this race.
class DeletionLists : public osg::Referenced
{
public:
    explicit DeletionLists(unsigned int) {}

    /// Creates the lists of the state's context at the first call. The context must be current.
    static void make(osg::State& state);

protected:
    ~DeletionLists() override = default;

private:
    bool _areMade = false;
};

/// Measures the GPU time between begin() and end(). Results arrive some frames later; it never waits. Each graphics
/// context has one timer. It uses time stamps (GL_ARB_timer_query), which work within the queries of other code. Call
/// it on the draw side only, with the context current.
class FeedbackTimer : public osg::GraphicsObjectManager
{
public:
    struct Measured
    {
        unsigned int frameNumber;
        double seconds;
    };

    explicit FeedbackTimer(unsigned int contextId);
    static FeedbackTimer& of(osg::State& state);

    void begin();
    /// Does nothing if the context has no time stamps or too many measurements are unfinished.
    void end(unsigned int frameNumber);
    /// The measurements that the GPU has finished since the last call.
    std::vector<Measured> takeFinished();

    void flushDeletedGLObjects(double, double&) override {}
    void flushAllDeletedGLObjects() override {}
    void deleteAllGLObjects() override;
    void discardAllGLObjects() override;

protected:
    ~FeedbackTimer() override = default;

private:
    struct Stamps
    {
        GLuint queries[2]; ///< of the begin and the end
        unsigned int frameNumber;
    };
    static constexpr std::size_t maxInFlight = 16;

    osg::GLExtensions* _gl;
    GLint _clockBits;             ///< 0: no time stamps
    std::deque<Stamps> _inFlight; ///< the oldest first; the last has no end time stamp while _isMeasuring
    bool _isMeasuring = false;
};

} // namespace osgGpuAnimation
