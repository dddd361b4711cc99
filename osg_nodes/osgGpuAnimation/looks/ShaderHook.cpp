// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/ShaderHook.h>

#include <ShaderSources.h>

#include <osg/Notify>
#include <osg/observer_ptr>
#include <osg/State>

#include <atomic>
#include <map>
#include <mutex>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

std::atomic<bool> hasHooks{false};

struct Function
{
    osg::Shader::Type type;
    const char* name;
    const char* declaration;
};

/// By ShaderHook::Place.
constexpr Function functions[ShaderHook::placeCount] = {
    {osg::Shader::VERTEX, "hostEyeVertex", "void hostEyeVertex(inout vec4 vertex, inout vec3 normal)"},
    {osg::Shader::VERTEX, "hostClipVertex", "void hostClipVertex(inout vec4 position, vec4 vertex)"},
    {osg::Shader::FRAGMENT, "hostMaterial",
     "void hostMaterial(inout vec4 baseColor, inout vec3 emission, inout vec3 metallicRoughnessOcclusion, inout vec3 "
     "normal)"},
    {osg::Shader::FRAGMENT, "hostLitColor", "void hostLitColor(inout vec4 color)"},
    {osg::Shader::FRAGMENT, "hostFinalColor", "void hostFinalColor(inout vec4 color)"},
};

/// One shader for all hooks with a text, as programs are shared by the addresses of their shaders.
osg::ref_ptr<osg::Shader> shaderOf(const Function& function, const std::string& text)
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
    const Function& function = functions[static_cast<std::size_t>(place)];
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
