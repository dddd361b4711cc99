// SPDX-License-Identifier: MIT
// Draws a SkinnedGeometry: skins, then reproduces the fixed pipeline. DRAW_...: see ShaderKey in
// nodes/shading/ShaderPermutations.h. POSE_COLORED: 1: the mesh has colours; 2: only its morph targets have colours.
#pragma import_defines(POSE_COLORED, POSE_INSTANCED)

void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
vec4 osgGpuAnimationTint();
void osgGpuAnimationMorphColor(inout vec4 color);
void osgGpuAnimationMorphTextureCoordinate(inout vec2 coordinate);

out vec3 viewPosition;
out vec3 viewNormal;
out vec4 vertexColor;
out vec2 textureCoordinate;

void passSurface()
{
    vertexColor = osgGpuAnimationTint();
#ifdef POSE_COLORED
#if POSE_COLORED == 1
    vec4 color = gl_Color;
#else
    vec4 color = vec4(1.0); // without a colour array gl_Color contains a material's colour
#endif
    osgGpuAnimationMorphColor(color);
    vertexColor *= color;
#endif
    textureCoordinate = gl_MultiTexCoord0.xy;
    osgGpuAnimationMorphTextureCoordinate(textureCoordinate);
#if DRAW_TEXTURE_MATRIX && defined(GL_ARB_compatibility)
    textureCoordinate = (gl_TextureMatrix[0] * vec4(textureCoordinate, 0.0, 1.0)).xy;
#endif
}

void main()
{
    vec4 vertex = gl_Vertex;
    vec3 normal = gl_Normal;
    osgGpuAnimationSkin(vertex, normal);
#ifdef POSE_INSTANCED
    viewPosition = vertex.xyz; // already in eye space
    viewNormal = normal;
#else
    viewPosition = (gl_ModelViewMatrix * vertex).xyz;
    viewNormal = gl_NormalMatrix * normal;
#endif
#if DRAW_COLOR || DRAW_ALPHA
    passSurface();
#endif
#if DRAW_CLIP_PLANES && defined(GL_ARB_compatibility)
    gl_ClipVertex = vec4(viewPosition, 1.0);
#endif
    gl_Position = gl_ModelViewProjectionMatrix * vertex;
}
