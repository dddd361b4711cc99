// SPDX-License-Identifier: MIT
#include "nodes/GlCallTrace.h"

#include <osg/GL>
#include <osg/GLExtensions>

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

/// The function of that name in the libraries after this program in link order.
template <typename Function>
Function* next(const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// One wrapped pointer of GLExtensions; Tag distinguishes pointers of one type.
template <typename Tag, typename Return, typename... Arguments>
struct Wrapped
{
    static inline Return(GL_APIENTRY* real)(Arguments...) = nullptr;
    static inline const char* name = "";
    static Return GL_APIENTRY call(Arguments... arguments)
    {
        note(name);
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

struct MapTag;
struct MapRangeTag;
struct GetSubDataTag;
struct BeginQueryTag;
struct QueryResultTag;
struct QueryResult64Tag;
struct TimeStampTag;
struct WaitTag;
struct BeginFeedbackTag;
struct UploadTag;
struct UploadPartTag;
struct GetUniformLocationTag;
struct DrawInstancedTag;

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
    function(static_cast<BeginFeedbackTag*>(nullptr), gl.glBeginTransformFeedback, "glBeginTransformFeedback");
    function(static_cast<UploadTag*>(nullptr), gl.glBufferData, "glBufferData");
    function(static_cast<UploadPartTag*>(nullptr), gl.glBufferSubData, "glBufferSubData");
    function(static_cast<DrawInstancedTag*>(nullptr), gl.glDrawArraysInstanced, "glDrawArraysInstanced");
    function(static_cast<GetUniformLocationTag*>(nullptr), gl.glGetUniformLocation, "glGetUniformLocation");
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

GlCallTrace::GlCallTrace(osg::State& state) : _gl(state.get<osg::GLExtensions>())
{
    forEachPointer(*_gl, Wrapper());
    callsMade.clear();
    isTracing = true;
}

GlCallTrace::~GlCallTrace()
{
    isTracing = false;
    forEachPointer(*_gl, Unwrapper());
}

std::map<std::string, int> GlCallTrace::calls() const
{
    return callsMade;
}

int GlCallTrace::count(const std::string& name) const
{
    const auto known = callsMade.find(name);
    return known == callsMade.end() ? 0 : known->second;
}

} // namespace osgGpuAnimation

// The dynamic linker finds the program's own functions before the libraries': calls from OSG and from the kit arrive
// here first.
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
        osgGpuAnimation::next<decltype(glDrawArrays)>("glDrawArrays")(mode, first, count);
    }

} // extern "C"
