// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/environment/PrefilteredMap.h>

#include <osgGpuAnimation/gpu/FeedbackPass.h>

#include <osg/ClipPlane>
#include <osg/FrameBufferObject>
#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/State>
#include <ShaderSources.h>

#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

GLint valueOf(GLenum name)
{
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

void setMode(GLenum mode, bool isOn)
{
    if (isOn)
        glEnable(mode);
    else
        glDisable(mode);
}

/// RAII: GL draws whole pictures into framebuffer objects, whatever the scene has set. The destructor restores what GL
/// had, which is what OSG expects. Only the texture of the active unit is left to the caller.
class DrawingScope
{
public:
    explicit DrawingScope(osg::State& state) : _gl(state.get<osg::GLExtensions>())
    {
        state.unbindPixelBufferObject();
        for (const GLenum mode : {GL_DEPTH_TEST, GL_BLEND, GL_SCISSOR_TEST, GL_CULL_FACE, GL_COLOR_LOGIC_OP})
            change(mode, false);
        for (GLenum plane = 0; plane < 6; ++plane)
            change(GL_CLIP_PLANE0 + plane, false);
        // The core profile does not know it.
        if (state.getLastAppliedMode(GL_ALPHA_TEST)) change(GL_ALPHA_TEST, false);
        change(GL_TEXTURE_CUBE_MAP_SEAMLESS, true);
        glGetIntegerv(GL_VIEWPORT, _viewport);
        glGetIntegerv(GL_POLYGON_MODE, _polygonMode);
        glGetBooleanv(GL_COLOR_WRITEMASK, _colorMask);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        _gl->glGenVertexArrays(1, &_ownVertexArray);
        _gl->glBindVertexArray(_ownVertexArray);
        _gl->glGenFramebuffers(1, &_ownFramebuffer);
        _gl->glBindFramebuffer(GL_FRAMEBUFFER_EXT, _ownFramebuffer);
    }

    ~DrawingScope()
    {
        _gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER_EXT, static_cast<GLuint>(_drawFramebuffer));
        _gl->glBindFramebuffer(GL_READ_FRAMEBUFFER_EXT, static_cast<GLuint>(_readFramebuffer));
        _gl->glDeleteFramebuffers(1, &_ownFramebuffer);
        _gl->glBindVertexArray(static_cast<GLuint>(_vertexArray));
        _gl->glDeleteVertexArrays(1, &_ownVertexArray);
        _gl->glUseProgram(static_cast<GLuint>(_program));
        glPixelStorei(GL_UNPACK_ALIGNMENT, _alignment);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, _rowLength);
        glColorMask(_colorMask[0], _colorMask[1], _colorMask[2], _colorMask[3]);
        restorePolygonMode();
        glViewport(_viewport[0], _viewport[1], _viewport[2], _viewport[3]);
        for (const auto& [mode, wasOn] : _modes)
            setMode(mode, wasOn);
    }

    DrawingScope(const DrawingScope&) = delete;
    DrawingScope& operator=(const DrawingScope&) = delete;

private:
    void change(GLenum mode, bool isOn)
    {
        _modes.emplace_back(mode, glIsEnabled(mode) == GL_TRUE);
        setMode(mode, isOn);
    }

    /// The core profile has one mode for both sides.
    void restorePolygonMode() const
    {
        const auto front = static_cast<GLenum>(_polygonMode[0]), back = static_cast<GLenum>(_polygonMode[1]);
        glPolygonMode(GL_FRONT_AND_BACK, front);
        if (back != front && back != 0) glPolygonMode(GL_BACK, back);
    }

    osg::GLExtensions* _gl;
    std::vector<std::pair<GLenum, bool>> _modes; ///< whether they were on
    GLint _viewport[4], _polygonMode[2] = {GL_FILL, 0};
    GLboolean _colorMask[4];
    GLint _drawFramebuffer = valueOf(GL_DRAW_FRAMEBUFFER_BINDING_EXT);
    GLint _readFramebuffer = valueOf(GL_READ_FRAMEBUFFER_BINDING_EXT);
    GLint _vertexArray = valueOf(GL_VERTEX_ARRAY_BINDING), _program = valueOf(GL_CURRENT_PROGRAM);
    GLint _alignment = valueOf(GL_UNPACK_ALIGNMENT), _rowLength = valueOf(GL_UNPACK_ROW_LENGTH);
    GLuint _ownVertexArray = 0, _ownFramebuffer = 0;
};

GLenum faceTarget(int face)
{
    return GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face);
}

/// Gives the texture that is bound its levels. pixels: black, or null: undefined.
void allocateLevels(int count, const float* pixels)
{
    for (int level = 0; level < count; ++level)
        for (int face = 0; face < 6; ++face)
            glTexImage2D(faceTarget(face), level, GL_RGBA16F_ARB, RadianceCube::side >> level,
                         RadianceCube::side >> level, 0, GL_RGBA, GL_FLOAT, pixels);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BASE_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAX_LEVEL, count - 1);
}

/// RAII: binds a cube map with the radiance and all its mipmaps to the active unit.
class SourceTexture
{
public:
    SourceTexture(osg::GLExtensions& gl, const RadianceCube& radiance)
    {
        glGenTextures(1, &_name);
        glBindTexture(GL_TEXTURE_CUBE_MAP, _name);
        for (int face = 0; face < 6; ++face)
            glTexImage2D(faceTarget(face), 0, GL_RGBA16F_ARB, RadianceCube::side, RadianceCube::side, 0, GL_RGB,
                         GL_FLOAT, radiance.face(face).data());
        glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
        glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        gl.glGenerateMipmap(GL_TEXTURE_CUBE_MAP);
    }
    ~SourceTexture() { glDeleteTextures(1, &_name); }
    SourceTexture(const SourceTexture&) = delete;
    SourceTexture& operator=(const SourceTexture&) = delete;

private:
    GLuint _name = 0;
};

/// Makes all levels of the texture that is bound black.
void blacken(osg::State& state, int levels)
{
    state.unbindPixelBufferObject();
    const std::vector<float> black(static_cast<std::size_t>(RadianceCube::side * RadianceCube::side * 4), 0.0f);
    const GLint rowLength = valueOf(GL_UNPACK_ROW_LENGTH);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    allocateLevels(levels, black.data());
    glPixelStorei(GL_UNPACK_ROW_LENGTH, rowLength);
}

/// Draws all levels of all faces into the texture. The state's context must be current. Binds no texture to the active
/// unit in the end. Returns false, and draws nothing, if the program cannot be used.
bool prefilter(osg::State& state, GLuint texture, const RadianceCube& radiance)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const DrawingScope scope(state);
    const std::string version = "#version 330\n";
    const GLuint program = linkProgram(gl, "the program of the surroundings",
                                       {{GL_VERTEX_SHADER, version + shaders::prefilter_vert},
                                        {GL_FRAGMENT_SHADER, version + shaders::prefilter_frag}});
    if (program == 0) return false;
    const auto find = [&](const char* uniform) { return gl.glGetUniformLocation(program, uniform); };
    gl.glUseProgram(program);
    const SourceTexture source(gl, radiance);
    gl.glUniform1i(find("radiance"), static_cast<int>(state.getActiveTextureUnit()));
    gl.glUniform1f(find("side"), static_cast<float>(RadianceCube::side));
    for (int level = 0; level < PrefilteredMap::levels; ++level)
    {
        const int size = RadianceCube::side >> level;
        const float roughness = static_cast<float>(level) / (PrefilteredMap::levels - 1);
        gl.glUniform1f(find("alpha"), roughness * roughness);
        gl.glUniform1f(find("size"), static_cast<float>(size));
        glViewport(0, 0, size, size);
        for (int face = 0; face < 6; ++face)
        {
            gl.glFramebufferTexture2D(GL_FRAMEBUFFER_EXT, GL_COLOR_ATTACHMENT0_EXT, faceTarget(face), texture, level);
            gl.glUniform1i(find("face"), face);
            glDrawArrays(GL_TRIANGLES, 0, 3);
        }
    }
    gl.glDeleteProgram(program);
    return true;
}

} // namespace

PrefilteredMap::PrefilteredMap(const RadianceCube& radiance) : _radiance(&radiance)
{
    setName("osgGpuAnimation surroundings");
    setInternalFormat(GL_RGBA16F_ARB);
    setTextureSize(RadianceCube::side, RadianceCube::side);
    setFilter(MIN_FILTER, LINEAR_MIPMAP_LINEAR);
    setFilter(MAG_FILTER, LINEAR);
    for (const WrapParameter wrap : {WRAP_S, WRAP_T, WRAP_R})
        setWrap(wrap, CLAMP_TO_EDGE);
    setUseHardwareMipMapGeneration(false);
    setResizeNonPowerOfTwoHint(false);
}

void PrefilteredMap::apply(osg::State& state) const
{
    const unsigned int contextId = state.getContextID();
    if (TextureObject* existing = getTextureObject(contextId))
    {
        existing->bind();
        if (getTextureParameterDirty(contextId)) applyTexParameters(GL_TEXTURE_CUBE_MAP, state);
        return;
    }
    const osg::ref_ptr<TextureObject> made = generateTextureObject(
        this, contextId, GL_TEXTURE_CUBE_MAP, levels, GL_RGBA16F_ARB, RadianceCube::side, RadianceCube::side, 1, 0);
    _textureObjectBuffer[contextId] = made;
    made->setAllocated(levels, GL_RGBA16F_ARB, RadianceCube::side, RadianceCube::side, 1, 0);
    made->bind();
    applyTexParameters(GL_TEXTURE_CUBE_MAP, state);
    allocateLevels(levels, nullptr);
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const bool canDraw = gl.glVersion >= 3.3f;
    if (!canDraw)
        OSG_WARN << "osgGpuAnimation: this context has OpenGL " << gl.glVersion
                 << "; surroundings from a picture need 3.3 and are not reflected" << std::endl;
    const bool isDrawn = canDraw && prefilter(state, made->id(), *_radiance);
    made->bind();
    if (!isDrawn) blacken(state, levels);
}

} // namespace osgGpuAnimation
