// SPDX-License-Identifier: MIT
// Draws a SkinnedGeometry (DRAW_SKINNED), or a mesh that does not move, with the inputs of character.frag. DRAW_...: see
// ShaderKey in looks/shading/ShaderPermutations.h. POSE_COLORED: 1: the mesh has colours; 2: only its morph targets have
// colours. HOOK_...: a host's function is linked, see looks/ShaderHook.h. Included above: color.glsl.
#pragma import_defines(POSE_COLORED, POSE_INSTANCED, MATERIAL_PBR, MATERIAL_TANGENTS, MATERIAL_MORE_COORDINATES)
#pragma import_defines(MATERIAL_TEXTURE_TRANSFORM)

void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
void osgGpuAnimationSkinTangent(inout vec4 vertex, inout vec3 normal, inout vec4 tangent);
vec4 osgGpuAnimationTint();
void osgGpuAnimationMorphColor(inout vec4 color);
void osgGpuAnimationMorphTextureCoordinate(inout vec2 coordinate);
#ifdef HOOK_EYE_VERTEX
void hostEyeVertex(inout vec4 vertex, inout vec3 normal);
#endif
#ifdef HOOK_CLIP_VERTEX
void hostClipVertex(inout vec4 position, vec4 vertex);
#endif

out vec3 viewPosition;
out vec3 viewNormal;
out vec4 vertexColor;
out vec2 textureCoordinate;
#ifdef MATERIAL_MORE_COORDINATES
in vec4 poseCoordinates;
out vec4 moreCoordinates;
#endif
#ifdef MATERIAL_TANGENTS
in vec4 poseTangent;
out vec4 viewTangent;
#endif

#ifdef MATERIAL_TEXTURE_TRANSFORM
uniform vec3 textureTransforms[6]; // of coordinates n: the rows 2 n and 2 n + 1 of a matrix

vec2 transformedCoordinate(int number, vec2 coordinate)
{
    vec3 place = vec3(coordinate, 1.0);
    return vec2(dot(textureTransforms[2 * number], place), dot(textureTransforms[2 * number + 1], place));
}
#endif

// Colours of vertices, targets and tints are stored as displayed.
vec4 shadedColor(vec4 color)
{
#ifdef MATERIAL_PBR
    color.rgb = linearColor(color.rgb);
#endif
    return color;
}

void passSurface()
{
#if DRAW_SKINNED
    vertexColor = shadedColor(osgGpuAnimationTint());
#else
    vertexColor = vec4(1.0);
#endif
#ifdef POSE_COLORED
#if POSE_COLORED == 1
    vec4 color = gl_Color;
#else
    vec4 color = vec4(1.0); // without a colour array gl_Color contains a material's colour
#endif
#if DRAW_SKINNED
    osgGpuAnimationMorphColor(color);
#endif
    vertexColor *= shadedColor(color);
#endif
    textureCoordinate = gl_MultiTexCoord0.xy;
#if DRAW_SKINNED
    osgGpuAnimationMorphTextureCoordinate(textureCoordinate);
#endif
#ifdef MATERIAL_MORE_COORDINATES
    moreCoordinates = poseCoordinates;
#endif
#ifdef MATERIAL_TEXTURE_TRANSFORM
    textureCoordinate = transformedCoordinate(0, textureCoordinate);
#ifdef MATERIAL_MORE_COORDINATES
    moreCoordinates.xy = transformedCoordinate(1, moreCoordinates.xy);
    moreCoordinates.zw = transformedCoordinate(2, moreCoordinates.zw);
#endif
#endif
#if DRAW_TEXTURE_MATRIX
    textureCoordinate = (gl_TextureMatrix[0] * vec4(textureCoordinate, 0.0, 1.0)).xy;
#endif
}

void main()
{
    vec4 vertex = gl_Vertex;
    vec3 normal = gl_Normal;
#ifdef MATERIAL_TANGENTS
    vec4 tangent = poseTangent;
#if DRAW_SKINNED
    osgGpuAnimationSkinTangent(vertex, normal, tangent);
#endif
#elif DRAW_SKINNED
    osgGpuAnimationSkin(vertex, normal);
#endif
#ifdef POSE_INSTANCED
    viewPosition = vertex.xyz; // already in eye space
    viewNormal = normal;
#else
    viewPosition = (gl_ModelViewMatrix * vertex).xyz;
    viewNormal = gl_NormalMatrix * normal;
#endif
#ifdef MATERIAL_TANGENTS
    viewTangent = tangent;
#ifndef POSE_INSTANCED
    mat3 toEye = mat3(gl_ModelViewMatrix);
    viewTangent.xyz = toEye * tangent.xyz;
    if (dot(cross(toEye[0], toEye[1]), toEye[2]) < 0.0) viewTangent.w = -viewTangent.w;
#endif
    if (dot(viewTangent.xyz, viewTangent.xyz) > 0.0) viewTangent.xyz = normalize(viewTangent.xyz);
#endif
#ifdef HOOK_EYE_VERTEX
    vec4 eyeVertex = vec4(viewPosition, 1.0);
    hostEyeVertex(eyeVertex, viewNormal);
    viewPosition = eyeVertex.xyz / eyeVertex.w;
#endif
#if DRAW_COLOR || DRAW_ALPHA
    passSurface();
#endif
#if DRAW_CLIP_PLANES
    gl_ClipVertex = vec4(viewPosition, 1.0);
#endif
#ifdef HOOK_EYE_VERTEX
    gl_Position = gl_ProjectionMatrix * eyeVertex;
#else
    gl_Position = gl_ModelViewProjectionMatrix * vertex;
#endif
#ifdef HOOK_CLIP_VERTEX
    hostClipVertex(gl_Position, vec4(viewPosition, 1.0));
#endif
}
