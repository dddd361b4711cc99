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

FeedbackTimer::Stamps FeedbackTimer::nextStamps()
{
    Stamps stamps{0, 0, 0};
    if (!_spare.empty())
    {
        stamps = _spare.back();
        _spare.pop_back();
        return stamps;
    }
    _gl->glGenQueries(1, &stamps.begin);
    _gl->glGenQueries(1, &stamps.end);
    return stamps;
}

void FeedbackTimer::begin()
{
    _isMeasuring = _clockBits > 0 && _inFlight.size() < maxInFlight;
    if (!_isMeasuring) return;
    _inFlight.push_back(nextStamps());
    _gl->glQueryCounter(_inFlight.back().begin, GL_TIMESTAMP);
}

void FeedbackTimer::end(unsigned int frameNumber)
{
    if (!_isMeasuring) return;
    _isMeasuring = false;
    _inFlight.back().frameNumber = frameNumber;
    _gl->glQueryCounter(_inFlight.back().end, GL_TIMESTAMP);
}

std::vector<FeedbackTimer::Measured> FeedbackTimer::takeFinished()
{
    std::vector<Measured> measured;
    while (_inFlight.size() > (_isMeasuring ? 1u : 0u))
    {
        const Stamps stamps = _inFlight.front();
        GLuint isThere = 0;
        _gl->glGetQueryObjectuiv(stamps.end, GL_QUERY_RESULT_AVAILABLE, &isThere);
        if (isThere == 0) break;
        GLuint64 begin = 0, end = 0; // nanoseconds
        _gl->glGetQueryObjectui64v(stamps.begin, GL_QUERY_RESULT, &begin);
        _gl->glGetQueryObjectui64v(stamps.end, GL_QUERY_RESULT, &end);
        // Skips a measurement during which the clock wrapped.
        if (end >= begin) measured.push_back({stamps.frameNumber, 1e-9 * static_cast<double>(end - begin)});
        _inFlight.pop_front();
        _spare.push_back(stamps);
    }
    return measured;
}

void FeedbackTimer::deleteAllGLObjects()
{
    _spare.insert(_spare.end(), _inFlight.begin(), _inFlight.end());
    for (const Stamps& stamps : _spare)
    {
        _gl->glDeleteQueries(1, &stamps.begin);
        _gl->glDeleteQueries(1, &stamps.end);
    }
    discardAllGLObjects();
}

void FeedbackTimer::discardAllGLObjects()
{
    _inFlight.clear();
    _spare.clear();
    _isMeasuring = false;
}

} // namespace osgGpuAnimation
