// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Shader>

namespace osgGpuAnimation
{

/// A place where the kit's programs call a function of a ShaderHook.
struct HookPlace
{
    osg::Shader::Type type;  ///< of the shader that calls it
    const char* name;        ///< of the function
    const char* declaration; ///< of the function
    const char* defines;     ///< of programs that call it
};

/// By ShaderHook::Place.
constexpr HookPlace hookPlaces[] = {
    {osg::Shader::VERTEX, "hostEyeVertex", "void hostEyeVertex(inout vec4 vertex, inout vec3 normal)",
     "#define HOOK_EYE_VERTEX\n"},
    {osg::Shader::VERTEX, "hostClipVertex", "void hostClipVertex(inout vec4 position, vec4 vertex)",
     "#define HOOK_CLIP_VERTEX\n"},
    {osg::Shader::FRAGMENT, "hostMaterial",
     "void hostMaterial(inout vec4 baseColor, inout vec3 emission, inout vec3 metallicRoughnessOcclusion, inout vec3 "
     "normal)",
     "#define HOOK_MATERIAL\n#define GIVEN_MATERIAL\n"},
    {osg::Shader::FRAGMENT, "hostLitColor", "void hostLitColor(inout vec4 color)", "#define HOOK_LIT_COLOR\n"},
    {osg::Shader::FRAGMENT, "hostFinalColor", "void hostFinalColor(inout vec4 color)", "#define HOOK_FINAL_COLOR\n"},
};

} // namespace osgGpuAnimation
