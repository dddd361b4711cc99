// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>

#include <cstddef>

namespace osgGpuAnimation
{

/// A GL buffer object that shaders read as a buffer texture, in one graphics context. GL names are made at first use
/// and must be given back by release() with the context current (or dropped with it by discard()).
class BufferTexture
{
public:
    /// format: GL_RGBA32F or GL_RGBA32UI, 16 bytes a texel; GL_RGBA8, 4 bytes, for shaders alone.
    BufferTexture(osg::GLExtensions& gl, GLenum format) : _gl(&gl), _format(format) {}
    ~BufferTexture() = default;
    BufferTexture(const BufferTexture&) = delete;
    BufferTexture& operator=(const BufferTexture&) = delete;

    static constexpr std::size_t texelBytes = 16;

    /// Room for that many bytes: grows by half at least, never shrinks. The content is undefined after growth.
    /// True if the storage is new.
    bool reserve(std::size_t bytes);
    /// New content from the buffer's start; reserves first. Storage in use by earlier draws is not waited for.
    void upload(const void* data, std::size_t bytes);
    /// Replaces a part of what was uploaded.
    void uploadPart(std::size_t offset, const void* data, std::size_t bytes);

    /// Lets vertex attributes [location, location + count) read 16 bytes each, one behind the other, from byteOffset
    /// on, and from one element to the next stride bytes on. divisor: 0 for an element a vertex, 1 for one a GL
    /// instance.
    void bindAttributes(unsigned int location, unsigned int count, std::size_t stride, std::size_t byteOffset,
                        unsigned int divisor) const;

    GLuint buffer() const { return _buffer; }
    GLuint texture() const { return _texture; }

    void release();
    void discard();

private:
    void create();

    osg::GLExtensions* _gl;
    GLenum _format;
    GLuint _buffer = 0;
    GLuint _texture = 0;
    std::size_t _capacity = 0;
};

} // namespace osgGpuAnimation
