// SPDX-License-Identifier: MIT
#pragma once

// Windows' own gl.h has GL 1.1. On Windows, CMake includes this header before each of our sources that use OSG; OSG's
// headers then find the names that Mesa's gl.h has.
#include <osg/GL>

#include <GL/glext.h>

// A mapping mode of windows.h, which MinGW's gl.h includes; osgAnimation's name of something else.
#undef RELATIVE
