// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"

#include <osg/GL>
#include <osg/GLExtensions>
#include <osg/State>
#include <osg/TextureBuffer>
#include <osg/VertexArrayState>

#include <map>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <dlfcn.h>

namespace osgGpuAnimation
{

namespace
{

/// Compares what a context has bound with what its osg::State has recorded, for code that binds past osg::State: the
/// next drawable of a host relies on the record. The context must be current; the comparison binds nothing.
class GlBindings
{
public:
    explicit GlBindings(osg::State& state) : _state(state), _gl(*state.get<osg::GLExtensions>())
    {
        osg::setGLExtensionFuncPtr(_getAttribute, "glGetVertexAttribiv");
        osg::setGLExtensionFuncPtr(_getIndexed, "glGetIntegeri_v");
    }

    /// Each difference, "array buffer: 7, recorded 0"; empty: none.
    std::vector<std::string> differences()
    {
        _found.clear();
        compareBuffers();
        compareTextures();
        const osg::Program::PerContextProgram* program = _state.getLastAppliedProgramObject();
        compare("program", integer(GL_CURRENT_PROGRAM), program ? program->getHandle() : 0);
        const GLuint arrayObject = _state.getCurrentVertexArrayObject();
        compare("vertex array object", integer(0x85B5), arrayObject); // GL_VERTEX_ARRAY_BINDING
        osg::VertexArrayState& arrays = *_state.getCurrentVertexArrayState();
        if (arrays.getVertexArrayObject() == arrayObject) compareArrays(arrays);
        return _found;
    }

    /// The framebuffer object that draws go to, which osg::State does not record.
    static GLint drawFramebuffer() { return static_cast<GLint>(integer(GL_DRAW_FRAMEBUFFER_BINDING_EXT)); }

private:
    static GLuint integer(GLenum name)
    {
        GLint value = 0;
        glGetIntegerv(name, &value);
        return static_cast<GLuint>(value);
    }

    static GLuint nameOf(const osg::GLBufferObject* buffer) { return buffer ? buffer->getGLObjectID() : 0; }

    void compare(const std::string& what, GLuint bound, GLuint recorded)
    {
        if (bound != recorded)
            _found.push_back(what + ": " + std::to_string(bound) + ", recorded " + std::to_string(recorded));
    }

    void compareBuffers()
    {
        osg::VertexArrayState& arrays = *_state.getCurrentVertexArrayState();
        compare("array buffer", integer(GL_ARRAY_BUFFER_BINDING_ARB), nameOf(arrays.getCurrentVertexBufferObject()));
        compare("pixel unpack buffer", integer(0x88EF), nameOf(_state.getCurrentPixelBufferObject()));
        compare("copy read buffer", integer(0x8F36), 0);
        compare("copy write buffer", integer(0x8F37), 0);
        constexpr GLenum feedback = 0x8C8F; // GL_TRANSFORM_FEEDBACK_BUFFER_BINDING
        compare("feedback buffer", integer(feedback), 0);
        for (GLuint i = 0; i < 4; ++i)
        {
            GLint buffer = 0;
            _getIndexed(feedback, i, &buffer);
            compare("feedback buffer " + std::to_string(i), static_cast<GLuint>(buffer), 0);
        }
    }

    void compareTextures()
    {
        constexpr std::pair<GLenum, GLenum> bindings[] = {{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
                                                          {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP},
                                                          {GL_TEXTURE_BUFFER, 0x8C2C}}; // GL_TEXTURE_BINDING_BUFFER
        const GLuint active = integer(GL_ACTIVE_TEXTURE) - GL_TEXTURE0;
        compare("active texture unit", active, _state.getActiveTextureUnit());
        for (GLuint unit = 0; unit < 32; ++unit)
        {
            const auto* recorded = dynamic_cast<const osg::Texture*>(
                _state.getLastAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE));
            const osg::Texture::TextureObject* object =
                recorded ? recorded->getTextureObject(_state.getContextID()) : nullptr;
            if (!object) continue; // without a record, OSG binds before it draws
            _gl.glActiveTexture(GL_TEXTURE0 + unit);
            for (const auto& [target, query] : bindings)
                if (recorded->getTextureTarget() == target)
                    compare("texture of unit " + std::to_string(unit), integer(query), object->id());
        }
        _gl.glActiveTexture(GL_TEXTURE0 + active);
    }

    void compareArrays(const osg::VertexArrayState& arrays)
    {
        compare("element array buffer", integer(GL_ELEMENT_ARRAY_BUFFER_BINDING_ARB),
                nameOf(const_cast<osg::VertexArrayState&>(arrays).getCurrentElementBufferObject()));
        std::map<GLuint, bool> recorded;
        for (GLuint i = 0; i < arrays._vertexAttribArrays.size(); ++i)
            recorded[i] = isActive(arrays._vertexAttribArrays[i].get());
        if (_state.getUseVertexAttributeAliasing())
        {
            const auto record = [&](const osg::VertexArrayState::ArrayDispatch* array, GLuint alias)
            { recorded[alias] = recorded[alias] || isActive(array); };
            record(arrays._vertexArray.get(), _state.getVertexAlias()._location);
            record(arrays._normalArray.get(), _state.getNormalAlias()._location);
            record(arrays._colorArray.get(), _state.getColorAlias()._location);
            for (GLuint unit = 0; unit < arrays._texCoordArrays.size(); ++unit)
                record(arrays._texCoordArrays[unit].get(), _state.getTexCoordAliasList()[unit]._location);
        }
        else if (integer(0x9126) != 1) // GL_CONTEXT_PROFILE_MASK: the core profile has no legacy arrays
            compareLegacyArrays(arrays);
        for (GLuint location = 0; location < integer(0x8869); ++location) // GL_MAX_VERTEX_ATTRIBS
        {
            const std::string name = "vertex attribute " + std::to_string(location);
            compare(name, attribute(location, 0x8622), recorded[location]); // GL_VERTEX_ATTRIB_ARRAY_ENABLED
            compare(name + "'s divisor", attribute(location, 0x88FE), 0);
        }
    }

    static bool isActive(const osg::VertexArrayState::ArrayDispatch* array) { return array && array->active; }

#ifdef GL_COLOR_ARRAY
    void compareLegacyArrays(const osg::VertexArrayState& arrays)
    {
        const auto compareArray = [&](const char* name, GLenum array, const auto& dispatch)
        { compare(name, glIsEnabled(array), isActive(dispatch.get())); };
        compareArray("vertex array", GL_VERTEX_ARRAY, arrays._vertexArray);
        compareArray("normal array", GL_NORMAL_ARRAY, arrays._normalArray);
        compareArray("colour array", GL_COLOR_ARRAY, arrays._colorArray);
        compareArray("second colour array", GL_SECONDARY_COLOR_ARRAY, arrays._secondaryColorArray);
        compareArray("fog coordinate array", GL_FOG_COORDINATE_ARRAY, arrays._fogCoordArray);
        const GLuint active = integer(GL_CLIENT_ACTIVE_TEXTURE) - GL_TEXTURE0;
        for (GLuint unit = 0; unit < arrays._texCoordArrays.size(); ++unit)
        {
            _gl.glClientActiveTexture(GL_TEXTURE0 + unit);
            compareArray("texture coordinate array", GL_TEXTURE_COORD_ARRAY, arrays._texCoordArrays[unit]);
        }
        _gl.glClientActiveTexture(GL_TEXTURE0 + active);
    }
#else // an OSG without the fixed pipeline
    void compareLegacyArrays(const osg::VertexArrayState&) {}
#endif

    GLuint attribute(GLuint location, GLenum name) const
    {
        GLint value = 0;
        _getAttribute(location, name, &value);
        return static_cast<GLuint>(value);
    }

    osg::State& _state;
    osg::GLExtensions& _gl;
    void(GL_APIENTRY* _getAttribute)(GLuint, GLenum, GLint*) = nullptr;
    void(GL_APIENTRY* _getIndexed)(GLenum, GLuint, GLint*) = nullptr;
    std::vector<std::string> _found;
};

std::map<std::string, int> callsMade;
bool isTracing = false;

/// The function of that name in the libraries behind this program.
template <typename Function>
Function* next(const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

osg::GLExtensions* extensions = nullptr;
bool isFeedbackActive = false;
int feedbackDrawsChecked = 0;
std::vector<std::string> conflicts;

GLint integer(GLenum name)
{
    GLint value = 0;
    next<decltype(glGetIntegerv)>("glGetIntegerv")(name, &value);
    return value;
}

/// Binding points of buffers that OpenGL 3.3 has, and the queries of what they hold.
constexpr std::pair<const char*, GLenum> bindingPoints[] = {{"array", GL_ARRAY_BUFFER_BINDING_ARB},
                                                            {"element array", GL_ELEMENT_ARRAY_BUFFER_BINDING_ARB},
                                                            {"pixel pack", 0x88ED},
                                                            {"pixel unpack", 0x88EF},
                                                            {"texture buffer", 0x8C2A},
                                                            {"copy read", 0x8F36},
                                                            {"copy write", 0x8F37},
                                                            {"uniform", 0x8A28}};

/// What every binding point holds, but for those of feedback; 0: nothing.
std::vector<std::pair<std::string, GLint>> boundBuffers()
{
    using GetAttribute = void(GL_APIENTRY*)(GLuint, GLenum, GLint*);
    static const auto getAttribute = reinterpret_cast<GetAttribute>(osg::getGLExtensionFuncPtr("glGetVertexAttribiv"));
    std::vector<std::pair<std::string, GLint>> found;
    for (const auto& [name, query] : bindingPoints)
        found.emplace_back(name, integer(query));
    for (GLint i = 0, end = integer(0x8869); i < end; ++i) // GL_MAX_VERTEX_ATTRIBS
    {
        GLint buffer = 0;
        getAttribute(static_cast<GLuint>(i), 0x889F, &buffer); // GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING
        found.emplace_back("vertex attribute " + std::to_string(i), buffer);
    }
    const GLint active = integer(GL_ACTIVE_TEXTURE);
    for (GLint i = 0, end = integer(0x8B4D); i < end; ++i) // GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS
    {
        extensions->glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        if (integer(0x8C2C) == 0) continue; // GL_TEXTURE_BINDING_BUFFER
        GLint buffer = 0;
        glGetTexLevelParameteriv(0x8C2A, 0, 0x8C2D, &buffer); // GL_TEXTURE_BUFFER_DATA_STORE_BINDING
        found.emplace_back("texture unit " + std::to_string(i), buffer);
    }
    extensions->glActiveTexture(static_cast<GLenum>(active));
    return found;
}

void checkFeedbackDraw()
{
    if (!isTracing || !isFeedbackActive) return;
    const GLint written = integer(0x8C8F); // GL_TRANSFORM_FEEDBACK_BUFFER_BINDING
    ++feedbackDrawsChecked;
    const std::string draw = "feedback draw " + std::to_string(feedbackDrawsChecked) + ": ";
    if (written == 0) conflicts.push_back(draw + "no buffer to write");
    for (const auto& [where, buffer] : boundBuffers())
        if (buffer == written) conflicts.push_back(draw + where);
}

osg::State* watched = nullptr;
GLint watchedFramebuffer = -1; ///< -1: none
int bindingChecksMade = 0;
std::set<std::string> differences;

/// OSG asks GL for errors: nothing of ours is going on.
void checkBindings()
{
    if (!watched || isFeedbackActive) return;
    osg::State& state = *watched;
    watched = nullptr; // the queries below are not watched
    isTracing = false;
    for (const std::string& difference : GlBindings(state).differences())
        differences.insert(difference);
    if (const GLint bound = GlBindings::drawFramebuffer(); watchedFramebuffer >= 0 && bound != watchedFramebuffer)
        differences.insert("draw framebuffer: " + std::to_string(bound));
    ++bindingChecksMade;
    isTracing = true;
    watched = &state;
}

/// Notes a call that is to come, and checks what it draws.
void enter(const std::string& name)
{
    if (name == "glGetError") return checkBindings();
    if (isTracing) ++callsMade[name];
    if (name == "glBeginTransformFeedback") isFeedbackActive = true;
    if (name == "glEndTransformFeedback") isFeedbackActive = false;
    if (name == "glDrawArrays" || name == "glDrawArraysInstanced") checkFeedbackDraw();
}

/// A function that OSG fetches by pointer, replaced.
template <auto pointer>
struct Wrapped;

template <typename Return, typename... Arguments, Return (GL_APIENTRY* osg::GLExtensions::*pointer)(Arguments...)>
struct Wrapped<pointer>
{
    static inline Return(GL_APIENTRY* real)(Arguments...) = nullptr;
    static inline std::string name;
    static Return GL_APIENTRY call(Arguments... arguments)
    {
        enter(name);
        if constexpr (std::is_same_v<std::tuple<Arguments...>, std::tuple<GLint, GLint>>)
            if (name == "glUniform1i" && std::get<0>(std::tie(arguments...)) < 0)
                enter("glUniform1i of a uniform that is not there");
        return real(arguments...);
    }
    static void wrap(osg::GLExtensions& gl, const char* itsName)
    {
        if (!(gl.*pointer) || gl.*pointer == &call) return;
        real = std::exchange(gl.*pointer, &call);
        name = itsName;
    }
    static void unwrap(osg::GLExtensions& gl)
    {
        if (gl.*pointer == &call) gl.*pointer = real;
    }
};

template <typename Visit>
void forEachPointer(Visit visit)
{
    using Gl = osg::GLExtensions;
    visit(Wrapped<&Gl::glMapBuffer>(), "glMapBuffer");
    visit(Wrapped<&Gl::glMapBufferRange>(), "glMapBufferRange");
    visit(Wrapped<&Gl::glGetBufferSubData>(), "glGetBufferSubData");
    visit(Wrapped<&Gl::glBeginQuery>(), "glBeginQuery");
    visit(Wrapped<&Gl::glGetQueryObjectuiv>(), "glGetQueryObjectuiv");
    visit(Wrapped<&Gl::glGetQueryObjectui64v>(), "glGetQueryObjectui64v");
    visit(Wrapped<&Gl::glQueryCounter>(), "glQueryCounter");
    visit(Wrapped<&Gl::glClientWaitSync>(), "glClientWaitSync");
    visit(Wrapped<&Gl::glBeginTransformFeedback>(), "glBeginTransformFeedback");
    visit(Wrapped<&Gl::glEndTransformFeedback>(), "glEndTransformFeedback");
    visit(Wrapped<&Gl::glBufferData>(), "glBufferData");
    visit(Wrapped<&Gl::glBufferSubData>(), "glBufferSubData");
    visit(Wrapped<&Gl::glDrawArraysInstanced>(), "glDrawArraysInstanced");
    visit(Wrapped<&Gl::glDrawArraysInstancedBaseInstance>(), "glDrawArraysInstanced");
    visit(Wrapped<&Gl::glVertexAttribDivisor>(), "glVertexAttribDivisor");
    visit(Wrapped<&Gl::glUniform1i>(), "glUniform1i");
    visit(Wrapped<&Gl::glGetUniformLocation>(), "glGetUniformLocation");
    visit(Wrapped<&Gl::glCompileShader>(), "glCompileShader");
    visit(Wrapped<&Gl::glLinkProgram>(), "glLinkProgram");
}

} // namespace

GlCallTrace::GlCallTrace(osg::State& state)
    : _state(state), _gl(state.get<osg::GLExtensions>()), _errorChecks(state.getCheckForGLErrors())
{
    forEachPointer([this](auto wrapped, const char* name) { wrapped.wrap(*_gl, name); });
    callsMade.clear();
    conflicts.clear();
    feedbackDrawsChecked = 0;
    extensions = _gl;
    isTracing = true;
}

GlCallTrace::~GlCallTrace()
{
    watched = nullptr;
    isTracing = false;
    forEachPointer([this](auto wrapped, const char*) { wrapped.unwrap(*_gl); });
    _state.setCheckForGLErrors(_errorChecks);
}

void GlCallTrace::watchBindings(bool withFramebuffer)
{
    _state.setCheckForGLErrors(osg::State::ONCE_PER_ATTRIBUTE);
    differences.clear();
    bindingChecksMade = 0;
    watchedFramebuffer = withFramebuffer ? GlBindings::drawFramebuffer() : -1;
    watched = &_state;
}

const std::set<std::string>& GlCallTrace::bindingDifferences() const
{
    return differences;
}

int GlCallTrace::bindingChecks() const
{
    return bindingChecksMade;
}

std::map<std::string, int> GlCallTrace::calls() const
{
    return callsMade;
}

int GlCallTrace::feedbackDraws() const
{
    return feedbackDrawsChecked;
}

const std::vector<std::string>& GlCallTrace::feedbackConflicts() const
{
    return conflicts;
}

int GlCallTrace::count(const std::string& name) const
{
    const auto known = callsMade.find(name);
    return known == callsMade.end() ? 0 : known->second;
}

} // namespace osgGpuAnimation

using namespace osgGpuAnimation;

// The program's own functions stand before the libraries': calls from OSG and from the kit come here first.
#define BEFORE_THE_LIBRARYS(Return, function, parameters, ...)                                                         \
    extern "C" Return GL_APIENTRY function parameters                                                                  \
    {                                                                                                                  \
        enter(#function);                                                                                              \
        return next<decltype(function)>(#function)(__VA_ARGS__);                                                       \
    }

BEFORE_THE_LIBRARYS(void, glGetIntegerv, (GLenum name, GLint* values), name, values)
BEFORE_THE_LIBRARYS(void, glGetFloatv, (GLenum name, GLfloat* values), name, values)
BEFORE_THE_LIBRARYS(void, glGetBooleanv, (GLenum name, GLboolean* values), name, values)
BEFORE_THE_LIBRARYS(GLenum, glGetError, (), )
BEFORE_THE_LIBRARYS(void, glFinish, (), )
BEFORE_THE_LIBRARYS(void, glReadPixels,
                    (GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type, GLvoid* out), x, y,
                    width, height, format, type, out)
BEFORE_THE_LIBRARYS(void, glGetTexImage, (GLenum target, GLint level, GLenum format, GLenum type, GLvoid* out), target,
                    level, format, type, out)
BEFORE_THE_LIBRARYS(void, glDrawArrays, (GLenum mode, GLint first, GLsizei count), mode, first, count)
