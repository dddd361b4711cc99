// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>

#include <algorithm>
#include <atomic>
#include <cassert>

namespace osgGpuAnimation
{

void bindBufferTexture(osg::State& state, unsigned int unit, GLuint texture)
{
    state.setActiveTextureUnit(unit);
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    if (state.getLastAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE))
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
}

bool BufferTexture::reserve(std::size_t bytes)
{
    bytes = std::max(bytes, texelBytes);
    if (bytes <= _capacity) return false;
    if (_buffer == 0)
    {
        static std::atomic<std::uint64_t> last{0};
        _serial = ++last;
        _gl->glGenBuffers(1, &_buffer);
        glGenTextures(1, &_texture);
    }
    _capacity = std::max(bytes, _capacity + _capacity / 8);
    _gl->glBindBuffer(GL_TEXTURE_BUFFER, _buffer);
    _gl->glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(_capacity), nullptr, GL_DYNAMIC_COPY);
    GLint bound = 0; // to the active unit; this query is as rare as new storage
    glGetIntegerv(GL_TEXTURE_BINDING_BUFFER, &bound);
    glBindTexture(GL_TEXTURE_BUFFER, _texture);
    _gl->glTexBuffer(GL_TEXTURE_BUFFER, _format, _buffer);
    glBindTexture(GL_TEXTURE_BUFFER, static_cast<GLuint>(bound));
    _gl->glBindBuffer(GL_TEXTURE_BUFFER, 0);
    return true;
}

void BufferTexture::upload(const void* data, std::size_t bytes)
{
    const bool isNew = reserve(bytes);
    _gl->glBindBuffer(GL_TEXTURE_BUFFER, _buffer);
    if (!isNew) _gl->glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(_capacity), nullptr, GL_DYNAMIC_COPY);
    _gl->glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
    _gl->glBindBuffer(GL_TEXTURE_BUFFER, 0);
}

void BufferTexture::uploadPart(std::size_t offset, const void* data, std::size_t bytes)
{
    assert(offset + bytes <= _capacity && "a part is within the reserved storage");
    _gl->glBindBuffer(GL_TEXTURE_BUFFER, _buffer);
    _gl->glBufferSubData(GL_TEXTURE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
    _gl->glBindBuffer(GL_TEXTURE_BUFFER, 0);
}

void BufferTexture::bindAttributes(unsigned int location, unsigned int count, std::size_t stride,
                                   std::size_t byteOffset, unsigned int divisor) const
{
    _gl->glBindBuffer(GL_ARRAY_BUFFER, _buffer);
    for (unsigned int i = 0; i < count; ++i)
    {
        const auto* offset = reinterpret_cast<const GLvoid*>(byteOffset + i * texelBytes);
        if (_format == GL_RGBA32UI_EXT)
            _gl->glVertexAttribIPointer(location + i, 4, GL_UNSIGNED_INT, static_cast<GLsizei>(stride), offset);
        else
            _gl->glVertexAttribPointer(location + i, 4, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride), offset);
        _gl->glVertexAttribDivisor(location + i, divisor);
        _gl->glEnableVertexAttribArray(location + i);
    }
    _gl->glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void BufferTexture::release()
{
    if (_buffer == 0) return;
    glDeleteTextures(1, &_texture);
    _gl->glDeleteBuffers(1, &_buffer);
    discard();
}

void BufferTexture::discard()
{
    _buffer = 0;
    _texture = 0;
    _serial = 0;
    _capacity = 0;
}

} // namespace osgGpuAnimation
