// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/ShaderHook.h>

#include <osg/observer_ptr>
#include <osg/State>

#include <map>
#include <mutex>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

/// One shader for all hooks with a text, as programs are shared by the addresses of their shaders.
osg::ref_ptr<osg::Shader> shaderOf(osg::Shader::Type type, const std::string& text)
{
    static std::mutex mutex;
    static std::map<std::pair<osg::Shader::Type, std::string>, osg::observer_ptr<osg::Shader>> shaders;
    const std::lock_guard<std::mutex> lock(mutex);
    osg::observer_ptr<osg::Shader>& known = shaders[{type, text}];
    osg::ref_ptr<osg::Shader> shader;
    if (known.lock(shader)) return shader;
    const bool hasVersion = text.find("#version") != std::string::npos;
    shader = new osg::Shader(type, hasVersion ? text : "#version 140\n" + text);
    known = shader.get();
    return shader;
}

} // namespace

void ShaderHook::set(Place place, const std::string& text)
{
    const osg::Shader::Type type = place <= Place::ClipVertex ? osg::Shader::VERTEX : osg::Shader::FRAGMENT;
    _place = place;
    _text = text;
    _shader = text.empty() ? nullptr : shaderOf(type, text);
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

osg::Shader* ShaderHook::applied(const osg::State& state, Place place)
{
    const unsigned int member = firstMember + static_cast<unsigned int>(place);
    const auto* hook = static_cast<const ShaderHook*>(state.getLastAppliedAttribute(VERTEXPROGRAM, member));
    return hook ? hook->getShader() : nullptr;
}

} // namespace osgGpuAnimation
