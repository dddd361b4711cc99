// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>
#include <osg/observer_ptr>
#include <osg/State>

#include <initializer_list>
#include <string>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// Between its making and its end feedback passes may run: rasterizing is off and a vertex array object of our own is
/// bound. At its end OSG's state is what OSG believes it to be.
class FeedbackScope
{
public:
    /// units: how many texture units, from 0 on, the passes bind buffer textures to.
    FeedbackScope(osg::State& state, GLuint vertexArray, int units);
    ~FeedbackScope();
    FeedbackScope(const FeedbackScope&) = delete;
    FeedbackScope& operator=(const FeedbackScope&) = delete;

private:
    osg::State& _state;
    int _units;
    osg::State::ApplyModeProxy _discard;
};

/// The vertex array objects of feedback passes. OpenGL contexts that share their objects (one OSG context number) share
/// all but these, so each osg::State has its own.
class FeedbackVertexArrays
{
public:
    /// The vertex array objects of one osg::State.
    struct Names
    {
        osg::observer_ptr<osg::State> state; ///< the state that they belong to
        GLuint pose = 0;                     ///< with the attributes of the pose pass
        GLuint empty = 0;                    ///< without any
    };

    explicit FeedbackVertexArrays(osg::GLExtensions& gl) : _gl(&gl) {} ///< gl: outlives this object.

    /// The state's context is current.
    const Names& of(osg::State& state);

    /// Where several contexts have some, only the last one's end can free them: the others go with their contexts.
    void release();
    void discard() { _names.clear(); } ///< forgets the names without OpenGL calls

private:
    osg::GLExtensions* _gl;
    std::vector<Names> _names; ///< hardly ever more than one
};

/// A vertex shader whose outputs are captured by transform feedback, nothing being rasterized: one pass of the
/// pipeline, in one graphics context. Used between FeedbackScope's beginning and end.
///
///     pass.use();
///     pass.setTexture("keyframes", 0, buffers.keyframes().texture());
///     pass.run(firstVertex, count, out.buffer(), byteOffset);
class FeedbackPass
{
public:
    /// Multiples of so many vertices an instance are drawn the fastest way.
    static constexpr std::size_t verticesOfFastest = 3;

    /// source: parts of the shader, put together behind a \#version line and layout.glsl. outputs: the vec4 outputs
    /// to capture, interleaved in that order. Failure to compile or link is reported once and leaves valid() false.
    FeedbackPass(osg::GLExtensions& gl, const char* name, std::initializer_list<const char*> source,
                 std::initializer_list<const char*> outputs);
    FeedbackPass(const FeedbackPass&) = delete;
    FeedbackPass& operator=(const FeedbackPass&) = delete;

    bool valid() const { return _program != 0; } ///< true if compiled and linked

    void use();                                  ///< makes the program current
    void setInt(const char* uniform, int value); ///< Sets an integer uniform. The program must be current.
    /// Binds a buffer texture to a unit and points the sampler there.
    void setTexture(const char* uniform, int unit, GLuint texture);
    /// Draws points [firstVertex, firstVertex + count) and writes 16 bytes an output for each into the buffer.
    void run(std::size_t firstVertex, std::size_t count, GLuint buffer, std::size_t byteOffset);
    /// The same for vertices [0, vertexCount) of each of so many GL instances, one instance after another; as triangles
    /// where they are threes, since llvmpipe has less to do for each primitive than for its vertices.
    void runInstanced(std::size_t vertexCount, std::size_t instanceCount, GLuint buffer, std::size_t byteOffset);

    void release();                  ///< Deletes the program. The context must be current.
    void discard() { _program = 0; } ///< forgets the program without OpenGL calls

private:
    void begin(GLenum mode, std::size_t count, GLuint buffer, std::size_t byteOffset);
    void end();
    GLint location(const char* uniform);
    bool link(const char* name, const std::string& source, const std::vector<const char*>& outputs);

    osg::GLExtensions* _gl;
    GLuint _program = 0;
    std::size_t _bytesPerVertex;
    std::unordered_map<std::string, GLint> _locations;
};

} // namespace osgGpuAnimation
