// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>
#include <osg/GLObjects>
#include <osg/State>

#include <deque>
#include <vector>

namespace osgGpuAnimation
{

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
