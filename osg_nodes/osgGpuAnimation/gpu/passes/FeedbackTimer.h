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

/// OSG's lists of a context's programs, shaders and vertex array objects to be deleted. OSG makes each when the first
/// object is dropped, by whatever thread drops it and without a lock, while the draw thread may be looking through its
/// lists: a DatabasePager whose last character goes would do so. Made beforehand, they only have to be found.
class DeletionLists : public osg::Referenced
{
public:
    explicit DeletionLists(unsigned int) {}

    /// Makes the lists of the state's context unless they are made. The context is current.
    static void make(osg::State& state);

protected:
    ~DeletionLists() override = default;

private:
    bool _areMade = false;
};

/// How long the GPU takes for what is drawn between begin() and end(), told some frames later and never waited for: one
/// object a graphics context, made at first use. Time stamps (GL_ARB_timer_query), which may be taken within others'
/// queries. Only to be called on the draw side, with the context current.
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
    /// Nothing is measured where the context has no time stamps or the GPU is too many measurements behind.
    void end(unsigned int frameNumber);
    /// What the GPU has finished since the last call.
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
        GLuint begin;
        GLuint end;
        unsigned int frameNumber;
    };
    static constexpr std::size_t mostInFlight = 16;

    Stamps nextStamps();

    osg::GLExtensions* _gl;
    std::deque<Stamps> _inFlight; ///< the oldest first; the last has no end yet where _isMeasuring
    std::vector<Stamps> _spare;
    bool _isMeasuring = false;
};

} // namespace osgGpuAnimation
