// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"

#include "support/GlBindings.h"

#include <osg/GL>
#include <osg/GLExtensions>

#include <tuple>
#include <type_traits>
#include <utility>

#include <dlfcn.h>

namespace osgGpuAnimation
{

namespace
{

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
    extern "C" Return GLAPIENTRY function parameters                                                                   \
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
