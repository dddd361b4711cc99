// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/FeedbackScope.h>

#include <osg/GLExtensions>
#include <osg/StateAttribute>
#include <osg/Texture>

#ifndef GL_RASTERIZER_DISCARD
#define GL_RASTERIZER_DISCARD 0x8C89
#endif

namespace osgGpuAnimation
{

FeedbackScope::FeedbackScope(osg::State& state, GLuint vertexArray, int units)
    : _state(state), _units(units), _discard(state, GL_RASTERIZER_DISCARD, true)
{
    _state.bindVertexArrayObject(vertexArray);
}

FeedbackScope::~FeedbackScope()
{
    osg::GLExtensions* gl = _state.get<osg::GLExtensions>();
    for (int unit = 0; unit < _units; ++unit)
    {
        gl->glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_BUFFER, 0);
        _state.haveAppliedTextureAttribute(static_cast<unsigned int>(unit), osg::StateAttribute::TEXTURE);
    }
    gl->glActiveTexture(GL_TEXTURE0 + _state.getActiveTextureUnit());
    gl->glUseProgram(0);
    _state.setLastAppliedProgramObject(nullptr);
    _state.haveAppliedAttribute(osg::StateAttribute::PROGRAM);
    _state.unbindVertexArrayObject();
}

} // namespace osgGpuAnimation
