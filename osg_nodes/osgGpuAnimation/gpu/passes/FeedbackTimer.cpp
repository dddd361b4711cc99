// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/passes/FeedbackTimer.h>

#include <osgGpuAnimation/gpu/detail/TimeStamps.h>

#include <osg/ContextData>
#include <osg/Program>
#include <osg/VertexArrayState>

namespace osgGpuAnimation
{

void DeletionLists::make(osg::State& state)
{
    const unsigned int contextId = state.getContextID();
    DeletionLists& lists = *osg::get<DeletionLists>(contextId);
    if (lists._areMade) return;
    lists._areMade = true;
    // Only a deletion creates a list.
    const osg::ref_ptr<osg::Shader> shader = new osg::Shader(osg::Shader::VERTEX);
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    const osg::ref_ptr<osg::Referenced> ofShader = new osg::Shader::PerContextShader(shader, contextId);
    const osg::ref_ptr<osg::Referenced> ofProgram = new osg::Program::PerContextProgram(program, contextId);
    const osg::ref_ptr<osg::VertexArrayState> arrays = new osg::VertexArrayState(&state);
    arrays->release();
}

FeedbackTimer::FeedbackTimer(unsigned int contextId)
    : osg::GraphicsObjectManager("FeedbackTimer", contextId), _gl(osg::GLExtensions::Get(contextId, true)),
      _clockBits(timeStampBits(*_gl))
{
}

FeedbackTimer& FeedbackTimer::of(osg::State& state)
{
    return *osg::get<FeedbackTimer>(state.getContextID());
}

void FeedbackTimer::begin()
{
    _isMeasuring = _clockBits > 0 && _inFlight.size() < maxInFlight;
    if (!_isMeasuring) return;
    Stamps& stamps = _inFlight.emplace_back();
    _gl->glGenQueries(2, stamps.queries);
    _gl->glQueryCounter(stamps.queries[0], GL_TIMESTAMP);
}

void FeedbackTimer::end(unsigned int frameNumber)
{
    if (!_isMeasuring) return;
    _isMeasuring = false;
    _inFlight.back().frameNumber = frameNumber;
    _gl->glQueryCounter(_inFlight.back().queries[1], GL_TIMESTAMP);
}

std::vector<FeedbackTimer::Measured> FeedbackTimer::takeFinished()
{
    std::vector<Measured> measured;
    while (_inFlight.size() > (_isMeasuring ? 1u : 0u))
    {
        const Stamps stamps = _inFlight.front();
        GLuint isThere = 0;
        _gl->glGetQueryObjectuiv(stamps.queries[1], GL_QUERY_RESULT_AVAILABLE, &isThere);
        if (isThere == 0) break;
        GLuint64 begin = 0, end = 0; // nanoseconds
        _gl->glGetQueryObjectui64v(stamps.queries[0], GL_QUERY_RESULT, &begin);
        _gl->glGetQueryObjectui64v(stamps.queries[1], GL_QUERY_RESULT, &end);
        // Skips a measurement during which the clock wrapped.
        if (end >= begin) measured.push_back({stamps.frameNumber, 1e-9 * static_cast<double>(end - begin)});
        _gl->glDeleteQueries(2, stamps.queries);
        _inFlight.pop_front();
    }
    return measured;
}

void FeedbackTimer::deleteAllGLObjects()
{
    for (const Stamps& stamps : _inFlight)
        _gl->glDeleteQueries(2, stamps.queries);
    discardAllGLObjects();
}

void FeedbackTimer::discardAllGLObjects()
{
    _inFlight.clear();
    _isMeasuring = false;
}

} // namespace osgGpuAnimation
