// SPDX-License-Identifier: MIT
#include "nodes/GlCallTrace.h"

#include "support/GlBindings.h"

#include <osg/GL>
#include <osg/GLExtensions>

#include <tuple>
#include <type_traits>

#include <dlfcn.h>

namespace osgGpuAnimation
{

namespace
{

std::map<std::string, int> callsMade;
bool isTracing = false;

void note(const char* name)
{
    if (isTracing) ++callsMade[name];
}

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

/// A binding point of buffers and the query of what it holds.
struct BindingPoint
{
    const char* name;
    GLenum query;
    GLenum maxIndices; ///< the query of the number of indexed points behind the general one; 0: none
    float since;       ///< OpenGL's version
};

constexpr BindingPoint bindingPoints[] = {
    {"array", GL_ARRAY_BUFFER_BINDING_ARB, 0, 1.5f},
    {"element array", GL_ELEMENT_ARRAY_BUFFER_BINDING_ARB, 0, 1.5f},
    {"pixel pack", 0x88ED, 0, 2.1f},
    {"pixel unpack", 0x88EF, 0, 2.1f},
    {"texture buffer", 0x8C2A, 0, 3.1f},
    {"copy read", 0x8F36, 0, 3.1f},
    {"copy write", 0x8F37, 0, 3.1f},
    {"uniform", 0x8A28, 0x8A2F, 3.1f},
    {"draw indirect", 0x8F43, 0, 4.0f},
    {"atomic counter", 0x92C1, 0x92DC, 4.2f},
    {"shader storage", 0x90D3, 0x90DD, 4.3f},
    {"dispatch indirect", 0x90EF, 0, 4.3f},
    {"query", 0x9193, 0, 4.4f},
};

/// Every binding point that holds a buffer, but for those of feedback.
std::vector<std::pair<std::string, GLint>> boundBuffers()
{
    using GetIndexed = void(GL_APIENTRY*)(GLenum, GLuint, GLint*);
    using GetAttribute = void(GL_APIENTRY*)(GLuint, GLenum, GLint*);
    static const auto getIndexed = reinterpret_cast<GetIndexed>(osg::getGLExtensionFuncPtr("glGetIntegeri_v"));
    static const auto getAttribute = reinterpret_cast<GetAttribute>(osg::getGLExtensionFuncPtr("glGetVertexAttribiv"));
    std::vector<std::pair<std::string, GLint>> found;
    const auto add = [&](const std::string& where, GLint buffer)
    {
        if (buffer != 0) found.emplace_back(where, buffer);
    };
    for (const BindingPoint& point : bindingPoints)
    {
        if (extensions->glVersion < point.since) continue;
        add(point.name, integer(point.query));
        for (GLint i = 0, end = point.maxIndices ? integer(point.maxIndices) : 0; i < end; ++i)
        {
            GLint buffer = 0;
            getIndexed(point.query, static_cast<GLuint>(i), &buffer);
            add(point.name + (" " + std::to_string(i)), buffer);
        }
    }
    for (GLint i = 0, end = integer(0x8869); i < end; ++i) // GL_MAX_VERTEX_ATTRIBS
    {
        GLint buffer = 0;
        getAttribute(static_cast<GLuint>(i), 0x889F, &buffer); // GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING
        add("vertex attribute " + std::to_string(i), buffer);
    }
    const GLint active = integer(GL_ACTIVE_TEXTURE);
    for (GLint i = 0, end = integer(0x8B4D); i < end; ++i) // GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS
    {
        extensions->glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        if (integer(0x8C2C) == 0) continue; // GL_TEXTURE_BINDING_BUFFER
        GLint buffer = 0;
        glGetTexLevelParameteriv(0x8C2A, 0, 0x8C2D, &buffer); // GL_TEXTURE_BUFFER_DATA_STORE_BINDING
        add("texture unit " + std::to_string(i), buffer);
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

constexpr const char* beginName = "glBeginTransformFeedback";
constexpr const char* endName = "glEndTransformFeedback";
constexpr const char* instancedName = "glDrawArraysInstanced";

struct MapTag;
struct MapRangeTag;
struct GetSubDataTag;
struct BeginQueryTag;
struct QueryResultTag;
struct QueryResult64Tag;
struct TimeStampTag;
struct WaitTag;
struct BeginFeedbackTag;
struct EndFeedbackTag;
struct UploadTag;
struct UploadPartTag;
struct GetUniformLocationTag;
struct DrawInstancedTag;
struct DrawBaseInstanceTag;
struct AttributeDivisorTag;
struct UniformTag;
struct CompileTag;
struct LinkTag;

/// One wrapped pointer of GLExtensions: Tag tells pointers of one type apart.
template <typename Tag, typename Return, typename... Arguments>
struct Wrapped
{
    static inline Return(GL_APIENTRY* real)(Arguments...) = nullptr;
    static inline const char* name = "";
    static Return GL_APIENTRY call(Arguments... arguments)
    {
        note(name);
        if constexpr (std::is_same_v<Tag, UniformTag>)
            if (std::get<0>(std::tie(arguments...)) < 0) note("glUniform1i of a uniform that is not there");
        if (name == beginName) isFeedbackActive = true;
        if (name == endName) isFeedbackActive = false;
        if (name == instancedName) checkFeedbackDraw();
        return real(arguments...);
    }
};

template <typename Tag, typename Return, typename... Arguments>
void wrap(Return(GL_APIENTRY*& pointer)(Arguments...), const char* name)
{
    using W = Wrapped<Tag, Return, Arguments...>;
    if (!pointer || pointer == &W::call) return;
    W::real = pointer;
    W::name = name;
    pointer = &W::call;
}

template <typename Tag, typename Return, typename... Arguments>
void unwrap(Return(GL_APIENTRY*& pointer)(Arguments...))
{
    using W = Wrapped<Tag, Return, Arguments...>;
    if (pointer == &W::call) pointer = W::real;
}

template <typename Function>
void forEachPointer(osg::GLExtensions& gl, Function function)
{
    function(static_cast<MapTag*>(nullptr), gl.glMapBuffer, "glMapBuffer");
    function(static_cast<MapRangeTag*>(nullptr), gl.glMapBufferRange, "glMapBufferRange");
    function(static_cast<GetSubDataTag*>(nullptr), gl.glGetBufferSubData, "glGetBufferSubData");
    function(static_cast<BeginQueryTag*>(nullptr), gl.glBeginQuery, "glBeginQuery");
    function(static_cast<QueryResultTag*>(nullptr), gl.glGetQueryObjectuiv, "glGetQueryObjectuiv");
    function(static_cast<QueryResult64Tag*>(nullptr), gl.glGetQueryObjectui64v, "glGetQueryObjectui64v");
    function(static_cast<TimeStampTag*>(nullptr), gl.glQueryCounter, "glQueryCounter");
    function(static_cast<WaitTag*>(nullptr), gl.glClientWaitSync, "glClientWaitSync");
    function(static_cast<BeginFeedbackTag*>(nullptr), gl.glBeginTransformFeedback, beginName);
    function(static_cast<EndFeedbackTag*>(nullptr), gl.glEndTransformFeedback, endName);
    function(static_cast<UploadTag*>(nullptr), gl.glBufferData, "glBufferData");
    function(static_cast<UploadPartTag*>(nullptr), gl.glBufferSubData, "glBufferSubData");
    function(static_cast<DrawInstancedTag*>(nullptr), gl.glDrawArraysInstanced, instancedName);
    function(static_cast<DrawBaseInstanceTag*>(nullptr), gl.glDrawArraysInstancedBaseInstance, instancedName);
    function(static_cast<AttributeDivisorTag*>(nullptr), gl.glVertexAttribDivisor, "glVertexAttribDivisor");
    function(static_cast<UniformTag*>(nullptr), gl.glUniform1i, "glUniform1i");
    function(static_cast<GetUniformLocationTag*>(nullptr), gl.glGetUniformLocation, "glGetUniformLocation");
    function(static_cast<CompileTag*>(nullptr), gl.glCompileShader, "glCompileShader");
    function(static_cast<LinkTag*>(nullptr), gl.glLinkProgram, "glLinkProgram");
}

struct Wrapper
{
    template <typename Tag, typename Pointer>
    void operator()(Tag*, Pointer& pointer, const char* name) const
    {
        wrap<Tag>(pointer, name);
    }
};

struct Unwrapper
{
    template <typename Tag, typename Pointer>
    void operator()(Tag*, Pointer& pointer, const char*) const
    {
        unwrap<Tag>(pointer);
    }
};

} // namespace

GlCallTrace::GlCallTrace(osg::State& state)
    : _state(state), _gl(state.get<osg::GLExtensions>()), _errorChecks(state.getCheckForGLErrors())
{
    forEachPointer(*_gl, Wrapper());
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
    forEachPointer(*_gl, Unwrapper());
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

// The program's own functions stand before the libraries': calls from OSG and from the kit come here first.
extern "C"
{

    void GLAPIENTRY glGetIntegerv(GLenum name, GLint* values)
    {
        osgGpuAnimation::note("glGetIntegerv");
        osgGpuAnimation::next<decltype(glGetIntegerv)>("glGetIntegerv")(name, values);
    }

    void GLAPIENTRY glGetFloatv(GLenum name, GLfloat* values)
    {
        osgGpuAnimation::note("glGetFloatv");
        osgGpuAnimation::next<decltype(glGetFloatv)>("glGetFloatv")(name, values);
    }

    void GLAPIENTRY glGetBooleanv(GLenum name, GLboolean* values)
    {
        osgGpuAnimation::note("glGetBooleanv");
        osgGpuAnimation::next<decltype(glGetBooleanv)>("glGetBooleanv")(name, values);
    }

    GLenum GLAPIENTRY glGetError()
    {
        osgGpuAnimation::checkBindings();
        return osgGpuAnimation::next<decltype(glGetError)>("glGetError")();
    }

    void GLAPIENTRY glFinish()
    {
        osgGpuAnimation::note("glFinish");
        osgGpuAnimation::next<decltype(glFinish)>("glFinish")();
    }

    void GLAPIENTRY glReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                                 GLvoid* out)
    {
        osgGpuAnimation::note("glReadPixels");
        osgGpuAnimation::next<decltype(glReadPixels)>("glReadPixels")(x, y, width, height, format, type, out);
    }

    void GLAPIENTRY glGetTexImage(GLenum target, GLint level, GLenum format, GLenum type, GLvoid* out)
    {
        osgGpuAnimation::note("glGetTexImage");
        osgGpuAnimation::next<decltype(glGetTexImage)>("glGetTexImage")(target, level, format, type, out);
    }

    void GLAPIENTRY glDrawArrays(GLenum mode, GLint first, GLsizei count)
    {
        osgGpuAnimation::note("glDrawArrays");
        osgGpuAnimation::checkFeedbackDraw();
        osgGpuAnimation::next<decltype(glDrawArrays)>("glDrawArrays")(mode, first, count);
    }

} // extern "C"
