#version 140
// SPDX-License-Identifier: MIT
// Above the texts with names of the fixed pipeline, which NVIDIA's compiler knows only with the directive. Here is none of
// these names: OSG writes its declarations behind the directive, and counts the place before it replaces names.
#extension GL_ARB_compatibility : enable
