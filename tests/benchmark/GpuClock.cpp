// SPDX-License-Identifier: MIT
#include "GpuClock.h"

#include <string>

#ifndef GL_TIMESTAMP
#define GL_TIMESTAMP 0x8E28
#endif
#ifndef GL_QUERY_COUNTER_BITS_ARB
#define GL_QUERY_COUNTER_BITS_ARB 0x8864
#endif

namespace osgGpuAnimation::benchmark
{

GpuClock::GpuClock(osg::State& state) : _gl(*state.get<osg::GLExtensions>())
{
    if (_gl.isARBTimerQuerySupported && !isSoftware())
        _gl.glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS_ARB, &_bits);
}

bool GpuClock::isSoftware()
{
    const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    for (const char* name : {"llvmpipe", "softpipe", "SwiftShader", "Basic Render"})
        if (renderer.find(name) != std::string::npos) return true;
    return false;
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
