// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>
#include <osg/State>
#include <osg/Texture> // the names of formats

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// Binds a buffer texture, or 0, to a texture unit and makes the unit active. If OSG has applied a texture of its own
/// to the unit, it applies that again before the next drawable.
void bindBufferTexture(osg::State& state, unsigned int unit, GLuint texture);

/// A GL buffer object that shaders read as a buffer texture, in one graphics context. It creates GL names at first
/// use. Call release() with the context current, or discard() after the end of the context.
class BufferTexture
{
public:
    /// format: GL_RGBA32F or GL_RGBA32UI, 16 bytes a texel; GL_RG32UI and GL_RGBA8, 8 and 4
    /// bytes, for shaders alone.
    BufferTexture(osg::GLExtensions& gl, GLenum format) : _gl(&gl), _format(format) {}
    ~BufferTexture() = default;
    BufferTexture(const BufferTexture&) = delete;
    BufferTexture& operator=(const BufferTexture&) = delete;

    static constexpr std::size_t texelBytes = 16;

    /// Reserves storage: it grows by at least an eighth and never shrinks. True if the storage is new; its content is
    /// then undefined.
    bool reserve(std::size_t bytes);
    /// Reserves and replaces the content from the start. It does not wait for earlier draws that use the storage.
    void upload(const void* data, std::size_t bytes);
    /// Replaces a part of the uploaded content.
    void uploadPart(std::size_t offset, const void* data, std::size_t bytes);

    /// Binds the vertex attributes [location, location + count), 16 consecutive bytes each. byteOffset: of the first
    /// element. stride: bytes between elements. divisor: 0 for one element per vertex, 1 for one per GL instance.
    void bindAttributes(unsigned int location, unsigned int count, std::size_t stride, std::size_t byteOffset,
                        unsigned int divisor) const;

    /// Identifies the buffer object among all that were ever created, as GL names do not; 0: none.
    std::uint64_t serial() const { return _serial; }
    GLuint buffer() const { return _buffer; }
    GLuint texture() const { return _texture; }

    void release();
    void discard();

private:
    osg::GLExtensions* _gl;
    GLenum _format;
    GLuint _buffer = 0;
    GLuint _texture = 0;
    std::uint64_t _serial = 0;
    std::size_t _capacity = 0;
};

/// Uploads the units that have changed, side by side ones together, and returns their bytes. uploaded: what identifies
/// the contents of the units in the buffer, by default none. identityOf(unit), elementsOf(unit): of the `count` present
/// ones. memory: kept from call to call.
template <typename Identity, typename Element, typename IdentityOf, typename ElementsOf>
std::size_t uploadChangedUnits(BufferTexture& buffer, std::size_t unitBytes, std::size_t count,
                               std::vector<Identity>& uploaded, std::vector<Element>& memory, IdentityOf identityOf,
                               ElementsOf elementsOf)
{
    std::size_t bytes = 0;
    if (buffer.reserve(count * unitBytes)) uploaded.clear(); // new storage is empty
    uploaded.resize(count);
    for (std::size_t first = 0, end = 0; first < count; first = end + 1)
    {
        memory.clear();
        for (end = first; end < count && uploaded[end] != identityOf(end); ++end)
        {
            const auto& elements = elementsOf(end);
            memory.insert(memory.end(), elements.begin(), elements.end());
            uploaded[end] = identityOf(end);
        }
        if (end - first == count) // all of it at once does not wait for earlier draws
            buffer.upload(memory.data(), count * unitBytes);
        else if (end > first)
            buffer.uploadPart(first * unitBytes, memory.data(), (end - first) * unitBytes);
        bytes += (end - first) * unitBytes;
    }
    return bytes;
}

} // namespace osgGpuAnimation
