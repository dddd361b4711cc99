// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/FeedbackPass.h>

#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>

#include <layout.glsl>

#include <osg/Notify>
#include <osg/StateAttribute>
#include <osg/Texture>
#include <ShaderSources.h>

#include <algorithm>

namespace osgGpuAnimation
{

FeedbackScope::FeedbackScope(osg::State& state, GLuint vertexArray)
    : _state(state), _discard(state, GL_RASTERIZER_DISCARD, true)
{
    _state.getCurrentVertexArrayState()->unbindVertexBufferObject(); // the passes bind others, and none at the end
    _state.bindVertexArrayObject(vertexArray);
    // The last draw of a mesh left its palette there, which the passes may write.
    bindBufferTexture(state, POSE_PALETTE_UNIT, 0);
}

FeedbackScope::~FeedbackScope()
{
    osg::GLExtensions* gl = _state.get<osg::GLExtensions>();
    for (unsigned int unit = 0; unit < unitCount; ++unit)
        if (_textures[unit] != 0) bindBufferTexture(_state, unit, 0);
    gl->glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->glUseProgram(0);
    _state.setLastAppliedProgramObject(nullptr);
    _state.haveAppliedAttribute(osg::StateAttribute::PROGRAM);
    _state.unbindVertexArrayObject();
}

void FeedbackScope::bindTexture(int unit, GLuint texture)
{
    GLuint& bound = _textures[static_cast<std::size_t>(unit)];
    if (bound == texture) return;
    bindBufferTexture(_state, static_cast<unsigned int>(unit), texture);
    bound = texture;
}

FeedbackVertexArrays::Names& FeedbackVertexArrays::of(osg::State& state)
{
    const auto known =
        std::find_if(_names.begin(), _names.end(), [&](const Names& names) { return names.state.get() == &state; });
    if (known != _names.end()) return *known;
    _names.erase(std::remove_if(_names.begin(), _names.end(), [](const Names& names) { return !names.state.valid(); }),
                 _names.end());
    Names names;
    names.state = &state;
    _gl->glGenVertexArrays(1, &names.pose);
    _gl->glGenVertexArrays(1, &names.empty);
    _names.push_back(names);
    return _names.back();
}

void FeedbackVertexArrays::release()
{
    if (_names.size() == 1)
    {
        _gl->glDeleteVertexArrays(1, &_names.front().pose);
        _gl->glDeleteVertexArrays(1, &_names.front().empty);
    }
    discard();
}

GLuint linkProgram(osg::GLExtensions& gl, const std::string& name,
                   std::initializer_list<std::pair<GLenum, std::string>> shaders,
                   const std::vector<const char*>& outputs)
{
    const GLuint program = gl.glCreateProgram();
    std::string log;
    const auto fail = [&](const char* step)
    {
        OSG_WARN << "osgGpuAnimation: " << name << " does not " << step << ": " << log << std::endl;
        gl.glDeleteProgram(program);
        return GLuint(0);
    };
    GLint ok = GL_FALSE;
    for (const auto& [type, source] : shaders)
    {
        const GLuint shader = gl.glCreateShader(type);
        const char* text = source.c_str();
        gl.glShaderSource(shader, 1, &text, nullptr);
        gl.glCompileShader(shader);
        gl.glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
        if (!ok) gl.getShaderInfoLog(shader, log);
        gl.glAttachShader(program, shader);
        gl.glDeleteShader(shader);
        if (!ok) return fail("compile");
    }
    if (!outputs.empty())
        gl.glTransformFeedbackVaryings(program, static_cast<GLsizei>(outputs.size()), outputs.data(),
                                       GL_INTERLEAVED_ATTRIBS);
    gl.glLinkProgram(program);
    gl.glGetProgramiv(program, GL_LINK_STATUS, &ok);
    if (ok) return program;
    gl.getProgramInfoLog(program, log);
    return fail("link");
}

FeedbackPass::FeedbackPass(osg::GLExtensions& gl, const char* name, std::initializer_list<const char*> source,
                           const std::vector<const char*>& outputs)
    : _gl(&gl), _bytesPerVertex(outputs.size() * 4 * sizeof(float))
{
    std::string text = "#version 330\n";
    text += shaders::layout_glsl;
    for (const char* part : source)
        text += part;
    _program = linkProgram(gl, std::string("pass ") + name, {{GL_VERTEX_SHADER, text}}, outputs);
}

FeedbackPass::Uniform& FeedbackPass::find(const char* uniform)
{
    const auto [known, isNew] = _uniforms.try_emplace(uniform);
    if (isNew) known->second.location = _gl->glGetUniformLocation(_program, uniform);
    return known->second;
}

bool FeedbackPass::setInt(const char* uniform, int value)
{
    Uniform& known = find(uniform);
    if (known.location < 0) return false;
    if (known.value != value) _gl->glUniform1i(known.location, value);
    known.value = value;
    return true;
}

void FeedbackPass::setVectors(const char* uniform, const std::vector<glm::vec4>& values)
{
    _gl->glUniform4fv(find(uniform).location, static_cast<GLsizei>(values.size()), &values.front().x);
}

void FeedbackPass::setTexture(FeedbackScope& scope, const char* uniform, int unit, GLuint texture)
{
    if (setInt(uniform, unit)) scope.bindTexture(unit, texture);
}

void FeedbackPass::begin(GLenum mode, std::size_t count, GLuint buffer, std::size_t byteOffset)
{
    _gl->glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer, static_cast<GLintptr>(byteOffset),
                           static_cast<GLsizeiptr>(count * _bytesPerVertex));
    _gl->glBeginTransformFeedback(mode);
}

void FeedbackPass::run(std::size_t firstVertex, std::size_t count, GLuint buffer, std::size_t byteOffset)
{
    if (count == 0) return;
    begin(GL_POINTS, count, buffer, byteOffset);
    glDrawArrays(GL_POINTS, static_cast<GLint>(firstVertex), static_cast<GLsizei>(count));
    _gl->glEndTransformFeedback();
}

void FeedbackPass::runInstanced(std::size_t vertexCount, std::size_t instanceCount, std::size_t firstInstance,
                                GLuint buffer, std::size_t byteOffset, bool triangles)
{
    if (vertexCount == 0 || instanceCount == 0) return;
    const GLenum mode = triangles && vertexCount % verticesOfFastest == 0 ? GL_TRIANGLES : GL_POINTS;
    begin(mode, vertexCount * instanceCount, buffer, byteOffset);
    const auto vertices = static_cast<GLsizei>(vertexCount), instances = static_cast<GLsizei>(instanceCount);
    if (firstInstance == 0)
        _gl->glDrawArraysInstanced(mode, 0, vertices, instances);
    else
        _gl->glDrawArraysInstancedBaseInstance(mode, 0, vertices, instances, static_cast<GLuint>(firstInstance));
    _gl->glEndTransformFeedback();
}

bool FeedbackPass::canOffsetInstances(const osg::GLExtensions& gl)
{
    // The pointer alone says nothing: libraries of GL have functions that their drivers lack.
    return gl.glDrawArraysInstancedBaseInstance &&
           osg::isGLExtensionOrVersionSupported(gl.contextID, "GL_ARB_base_instance", 4.2f);
}

bool FeedbackPass::canWrite(osg::GLExtensions& gl)
{
    constexpr std::size_t vertices = verticesOfFastest, instances = 2, texels = vertices * instances + 2;
    const char* const shader = "out vec4 place;\n"
                               "void main() { place = vec4(gl_VertexID, gl_InstanceID, 3.5, -1.0); }\n";
    FeedbackPass pass(gl, "feedback check", {shader}, {"place"});
    if (!pass.valid()) return false;
    const glm::vec4 untouched(7.0f);
    std::array<glm::vec4, texels> written;
    written.fill(untouched);
    BufferTexture out(gl, GL_RGBA32F_ARB);
    out.upload(written.data(), sizeof written);
    pass.use();
    pass.runInstanced(vertices, instances, 0, out.buffer(), sizeof untouched);
    gl.glBindBuffer(GL_TEXTURE_BUFFER, out.buffer());
    gl.glGetBufferSubData(GL_TEXTURE_BUFFER, 0, sizeof written, written.data());
    gl.glBindBuffer(GL_TEXTURE_BUFFER, 0);
    bool isRight = written.front() == untouched && written.back() == untouched;
    for (std::size_t i = 0; i < vertices * instances; ++i)
        isRight = isRight && written[i + 1] == glm::vec4(i % vertices, i / vertices, 3.5f, -1.0f);
    out.release();
    pass.release();
    for (int error = 0; error < 8 && !isRight && glGetError() != GL_NO_ERROR; ++error) // of a driver that refuses
    {
    }
    return isRight;
}

void FeedbackPass::release()
{
    if (_program != 0) _gl->glDeleteProgram(_program);
    discard();
}

} // namespace osgGpuAnimation
