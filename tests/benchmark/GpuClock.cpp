// SPDX-License-Identifier: MIT
#include "GpuClock.h"

#include <osgGpuAnimation/gpu/detail/Renderer.h>
#include <osgGpuAnimation/gpu/detail/TimeStamps.h>

namespace osgGpuAnimation::benchmark
{

GpuClock::GpuClock(osg::State& state)
    : _gl(*state.get<osg::GLExtensions>()), _bits(isSoftwareRenderer() ? 0 : timeStampBits(_gl))
{
}

GpuClock::~GpuClock()
{
    take();
    for (const GLuint query : _spare)
        _gl.glDeleteQueries(1, &query);
}

void GpuClock::stamp()
{
    if (!isThere()) return;
    GLuint query = 0;
    if (_spare.empty())
        _gl.glGenQueries(1, &query);
    else
    {
        query = _spare.back();
        _spare.pop_back();
    }
    _gl.glQueryCounter(query, GL_TIMESTAMP);
    _queries.push_back(query);
}

double GpuClock::take()
{
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < _queries.size(); i += 2)
    {
        GLuint64 begin = 0, end = 0; // nanoseconds
        _gl.glGetQueryObjectui64v(_queries[i], GL_QUERY_RESULT, &begin);
        _gl.glGetQueryObjectui64v(_queries[i + 1], GL_QUERY_RESULT, &end);
        sum += end > begin ? 1e-9 * static_cast<double>(end - begin) : 0.0;
    }
    _spare.insert(_spare.end(), _queries.begin(), _queries.end());
    _queries.clear();
    return sum;
}

} // namespace osgGpuAnimation::benchmark
