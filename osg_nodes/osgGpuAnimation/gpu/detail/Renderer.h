// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GL>

#include <string>

namespace osgGpuAnimation
{

/// GL_RENDERER of the current context; empty if it has none.
inline std::string rendererName()
{
    const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return name ? name : "";
}

/// True if the current context draws on the CPU: llvmpipe and the like.
inline bool isSoftwareRenderer()
{
    const std::string renderer = rendererName();
    for (const char* software : {"llvmpipe", "softpipe", "SwiftShader", "Basic Render"})
        if (renderer.find(software) != std::string::npos) return true;
    return false;
}

} // namespace osgGpuAnimation
