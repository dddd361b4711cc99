// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GL>

namespace osgGpuAnimation
{

/// False: OSG was built without the fixed pipeline (OPENGL_PROFILE=GLCORE). Such an OSG sets no lights, no fog and no
/// modes of textures, whatever the context is. This is the only place that tests OSG's macro.
#ifdef OSG_GL_FIXED_FUNCTION_AVAILABLE
constexpr bool hasFixedPipeline = true;
#else
constexpr bool hasFixedPipeline = false;
#endif

} // namespace osgGpuAnimation
