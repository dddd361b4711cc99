// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/ShaderHook.h>

#include <osgGpuAnimation/looks/shading/HookPlaces.h>

#include <ShaderSources.h>

#include <osg/Notify>
#include <osg/observer_ptr>
#include <osg/State>

#include <atomic>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

std::atomic<bool> hasHooks{false};

static_assert(std::size(hookPlaces) == ShaderHook::placeCount);

/// One shader for all hooks with a text, as programs are shared by the addresses of their shaders.
osg::ref_ptr<osg::Shader> shaderOf(const HookPlace& function, const std::string& text)
{
    static std::mutex mutex;
    static std::map<std::pair<osg::Shader::Type, std::string>, osg::observer_ptr<osg::Shader>> shaders;
    const std::lock_guard<std::mutex> lock(mutex);
    osg::observer_ptr<osg::Shader>& known = shaders[{function.type, text}];
    osg::ref_ptr<osg::Shader> shader;
    if (known.lock(shader)) return shader;
    const bool hasVersion = text.find("#version") != std::string::npos;
    shader = new osg::Shader(function.type, hasVersion ? text : shaders::version_glsl + text);
    shader->setName(std::string("ShaderHook ") + function.name);
    known = shader.get();
    return shader;
}

} // namespace

void ShaderHook::set(Place place, const std::string& text)
{
    const HookPlace& function = hookPlaces[static_cast<std::size_t>(place)];
    _place = place;
    _text = text;
    const bool isDefined = text.find(function.name) != std::string::npos;
    _shader = isDefined ? shaderOf(function, text) : nullptr;
    if (isDefined) hasHooks = true;
    if (isDefined || text.empty()) return;
    OSG_WARN << "osgGpuAnimation: a ShaderHook is left out: expected a definition of " << function.declaration
             << ", found none" << std::endl;
}

ShaderHook::ShaderHook(const ShaderHook& other, const osg::CopyOp& copyop)
    : osg::StateAttribute(other, copyop), _place(other._place), _text(other._text), _shader(other._shader)
{
}

int ShaderHook::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(ShaderHook, other);
    COMPARE_StateAttribute_Parameter(_place);
    COMPARE_StateAttribute_Parameter(_shader);
    return 0;
}

bool ShaderHook::exists()
{
    return hasHooks;
}

osg::Shader* ShaderHook::applied(const osg::State& state, Place place)
{
    const unsigned int member = firstMember + static_cast<unsigned int>(place);
    const auto* hook = static_cast<const ShaderHook*>(state.getLastAppliedAttribute(VERTEXPROGRAM, member));
    return hook ? hook->getShader() : nullptr;
}

} // namespace osgGpuAnimation
