// SPDX-License-Identifier: MIT
// The functions of lightShader(), see looks/CharacterProgram.h. Included above: light.glsl and what it includes.

vec3 osgGpuAnimationLight(vec3 baseColor, vec3 emission, vec3 metallicRoughnessOcclusion, vec3 normal)
{
    givenEmission = emission;
    givenSurface = metallicRoughnessOcclusion;
    givenNormal = normal;
    return litColor(baseColor);
}

vec3 osgGpuAnimationDisplay(vec3 color)
{
    return shownColor(color);
}

vec3 osgGpuAnimationFog(vec3 color)
{
#if DRAW_FOG
    return foggedColor(color);
#else
    return color;
#endif
}
