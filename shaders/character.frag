// SPDX-License-Identifier: MIT
// The colour of a fragment. DRAW_...: see ShaderKey in looks/shading/ShaderPermutations.h; HOOK_...: a host's function is
// linked, see looks/ShaderHook.h. Included above: light.glsl and what it includes.
#pragma import_defines(MATERIAL_BLENDED)

#ifdef HOOK_MATERIAL
void hostMaterial(inout vec4 baseColor, inout vec3 emission, inout vec3 metallicRoughnessOcclusion, inout vec3 normal);
#endif
#ifdef HOOK_LIT_COLOR
void hostLitColor(inout vec4 color);
#endif
#ifdef HOOK_FINAL_COLOR
void hostFinalColor(inout vec4 color);
#endif

out vec4 fragmentColor;

void main()
{
#if DRAW_COLOR
#ifdef HOOK_MATERIAL
    vec4 color;
    osgGpuAnimationMaterial(color, givenEmission, givenSurface, givenNormal);
    hostMaterial(color, givenEmission, givenSurface, givenNormal);
#else
    vec4 color = materialBaseColor();
#endif
#if defined(MATERIAL_TRANSMISSION) && !defined(MATERIAL_BLENDED)
    color.a = 1.0; // glTF 2.0, section 3.9.4
#endif
#if DRAW_LIGHTING
    color.rgb = litColor(color.rgb);
#endif
#ifdef MATERIAL_TRANSMISSION
    // Blended with ONE and ONE_MINUS_SRC_ALPHA: highlights cover what lies behind.
    float through = materialTransmittance() * (1.0 - clamp(materialSurface().x, 0.0, 1.0));
    float cover = max(1.0 - 0.96 * through, min(largest(color.rgb), 1.0));
    color.rgb /= cover;
#endif
#ifdef HOOK_LIT_COLOR
    hostLitColor(color);
#endif
    color.rgb = shownColor(color.rgb);
#if DRAW_FOG
    color.rgb = foggedColor(color.rgb);
#endif
#ifdef HOOK_FINAL_COLOR
    hostFinalColor(color);
#endif
#ifdef MATERIAL_TRANSMISSION
    color = vec4(color.rgb, 1.0) * (cover * color.a);
#endif
    fragmentColor = color;
#else
#if DRAW_ALPHA && defined(HOOK_MATERIAL)
    osgGpuAnimationMaterial(fragmentColor, givenEmission, givenSurface, givenNormal);
    hostMaterial(fragmentColor, givenEmission, givenSurface, givenNormal);
#elif DRAW_ALPHA
    fragmentColor = materialBaseColor();
#else
    fragmentColor = vec4(1.0);
#endif
#ifdef HOOK_FINAL_COLOR
    hostFinalColor(fragmentColor);
#endif
#endif
}
