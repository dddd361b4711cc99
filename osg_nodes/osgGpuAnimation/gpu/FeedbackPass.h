// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>
#include <osg/observer_ptr>
#include <osg/State>

#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// RAII: disables rasterization, binds a vertex array object for feedback passes and unbinds the palette of the last
/// draw: a buffer that feedback writes may have no other binding. The destructor restores the GL state that OSG
/// expects.
class FeedbackScope
{
public:
    /// vertexArray: the object whose attributes the passes read.
    FeedbackScope(osg::State& state, GLuint vertexArray);
    ~FeedbackScope();
    FeedbackScope(const FeedbackScope&) = delete;
    FeedbackScope& operator=(const FeedbackScope&) = delete;

    /// Binds a buffer texture to a unit below unitCount, unless the scope has bound it there.
    void bindTexture(int unit, GLuint texture);

    static constexpr int unitCount = 10; ///< texture units that passes may use

private:
    osg::State& _state;
    std::array<GLuint, unitCount> _textures{}; ///< by unit; 0: none
    osg::State::ApplyModeProxy _discard;
};

/// The vertex array objects of feedback passes, one pair per osg::State: GL contexts that share objects (one OSG
/// context ID) do not share vertex array objects.
class FeedbackVertexArrays
{
public:
    /// The GL names for one state.
    struct Names
    {
        osg::observer_ptr<osg::State> state; ///< null after the state's end
        GLuint pose = 0;                     ///< with the attributes of the pose pass
        GLuint empty = 0;                    ///< without attributes
        // What the attributes of `pose` point to: calls that change nothing are left out.
        std::uint64_t samples = 0;    ///< BufferTexture::serial() of the blend samples; 0: none
        std::size_t sampleStride = 0; ///< blend samples of an instance
        unsigned int sampleCount = 0; ///< enabled attributes
        std::uint64_t roots = 0;      ///< serial of the root matrices
        int rootDivisor = -1;         ///< -1: disabled
        std::uint64_t entries = 0;    ///< serial of the palette entries
        std::size_t firstEntry = 0;   ///< the first palette entry
    };

    /// Creates no GL objects yet.
    explicit FeedbackVertexArrays(osg::GLExtensions& gl) : _gl(&gl) {}

    /// The names for a state, created at the first call. The state's context must be current.
    Names& of(osg::State& state);

    /// Deletes the GL objects if only one state has some. With several states, each context deletes its own at its end.
    void release();
    /// Forgets the GL names without deleting them.
    void discard() { _names.clear(); }

private:
    osg::GLExtensions* _gl;
    std::vector<Names> _names; ///< almost always one
};

/// A program of these shaders, each a type and its text; 0, with one warning, if it does not compile or link. name: for
/// the warning. outputs: what transform feedback captures, interleaved.
GLuint linkProgram(osg::GLExtensions& gl, const std::string& name,
                   std::initializer_list<std::pair<GLenum, std::string>> shaders,
                   const std::vector<const char*>& outputs = {});

/// One pass of the pipeline in one graphics context: a vertex shader whose outputs transform feedback captures. Use it
/// within the lifetime of a FeedbackScope. Uniforms keep their values between frames; only changes are sent.
///
///     pass.use();
///     pass.setTexture(scope, "keyframes", 0, buffers.keyframes().texture());
///     pass.run(firstVertex, count, out.buffer(), byteOffset);
class FeedbackPass
{
public:
    /// Draws are fastest if the vertices per instance are a multiple of this number.
    static constexpr std::size_t verticesOfFastest = 3;

    /// source: parts of the shader, which follow a \#version line and layout.glsl. outputs: the vec4 outputs to
    /// capture, interleaved in this order. If the shader does not compile or link, the pass warns once and valid() is
    /// false.
    FeedbackPass(osg::GLExtensions& gl, const char* name, std::initializer_list<const char*> source,
                 const std::vector<const char*>& outputs);
    FeedbackPass(const FeedbackPass&) = delete;
    FeedbackPass& operator=(const FeedbackPass&) = delete;

    /// True if the program can run.
    bool valid() const { return _program != 0; }

    /// Makes the program current. Call it before the functions below.
    void use() { _gl->glUseProgram(_program); }
    /// Sets an int uniform. False if the program does not use it.
    bool setInt(const char* uniform, int value);
    /// Sets an array. values: one or more.
    void setVectors(const char* uniform, const std::vector<glm::vec4>& values);
    /// Binds a buffer texture to a unit and points the sampler there, if the program uses it.
    void setTexture(FeedbackScope& scope, const char* uniform, int unit, GLuint texture);
    /// Draws the points [firstVertex, firstVertex + count) and writes 16 bytes per output and point into the buffer.
    void run(std::size_t firstVertex, std::size_t count, GLuint buffer, std::size_t byteOffset);
    /// Does the same for the vertices [0, vertexCount) of each GL instance, instance by instance. It draws triangles if
    /// vertexCount is a multiple of 3 and `triangles` is true, since llvmpipe has a fixed cost per primitive.
    /// firstInstance: added to the index of attributes with a divisor; other than 0 only if canOffsetInstances().
    void runInstanced(std::size_t vertexCount, std::size_t instanceCount, std::size_t firstInstance, GLuint buffer,
                      std::size_t byteOffset, bool triangles = true);
    /// True if the context has OpenGL 4.2 or ARB_base_instance.
    static bool canOffsetInstances(const osg::GLExtensions& gl);
    /// True if feedback writes what a shader computes: runs one tiny pass and reads it back. Some drivers write
    /// nothing, or zeros. The vertex array object of the scope has no attributes.
    static bool canWrite(osg::GLExtensions& gl);

    /// Deletes the program. The context must be current.
    void release();
    /// Forgets the program without deleting it.
    void discard() { _program = 0; }

private:
    struct Uniform
    {
        GLint location = -1; ///< -1: the program does not use it
        int value = 0;       ///< of an int uniform, GL's initial one at first
    };

    void begin(GLenum mode, std::size_t count, GLuint buffer, std::size_t byteOffset);
    Uniform& find(const char* uniform);

    osg::GLExtensions* _gl;
    GLuint _program = 0;
    std::size_t _bytesPerVertex;
    std::unordered_map<std::string, Uniform> _uniforms;
};

} // namespace osgGpuAnimation
