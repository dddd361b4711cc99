// SPDX-License-Identifier: MIT
#pragma once

// Windows' own gl.h has GL 1.1. On Windows, CMake includes this header before each of our sources that use OSG; OSG's
// headers then find the names that Mesa's gl.h has.
#include <osg/GL>

#include <GL/glext.h>

// MinGW's gl.h includes windows.h. These macros of it are names in OSG's headers and in our sources.
#undef RELATIVE
#undef far
#undef near
