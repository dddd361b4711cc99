// SPDX-License-Identifier: MIT
// Morphing (glTF 2.0, section 3.7.2.2), then skinning by the palette (section 3.7.3.3). To use it in another program, link
// this shader, declare
//     void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
// and call it with the vertex and normal of the bind pose. It returns them in the space that gl_ModelViewMatrix transforms
// from: the character's own space, or eye space in an instanced draw of several characters.
// In instanced draws each GL instance is one instance of the batch or of poseDrawn, see AnimatedCrowd; vec4 osgGpuAnimationTint() is its
// colour. Attributes are bound to the locations of layout.glsl; SkinnedGeometry sets the uniforms when it draws.
//
// OSG's shader defines (StateSet::setDefine, see applySkinDefines) remove parts that a mesh does not need, since some
// drivers (llvmpipe) run both sides of every branch. Without the defines the uniforms decide. A SkinnedGeometry has
// POSE_INFLUENCES or POSE_SKINNED: without them, so for all other meshes, the functions change nothing.
#pragma import_defines(POSE_SKINNED, POSE_INFLUENCES, POSE_NO_MORPHS, POSE_INSTANCED, POSE_PLACED, POSE_LISTED)
#pragma import_defines(POSE_OUTFIT_COLORS, POSE_OUTFIT_PARTS)

#if defined(POSE_SKINNED) || defined(POSE_INFLUENCES)

uniform samplerBuffer posePalette; // entry e of instance i: rows at texel (e * poseStride + i) * 3
uniform int poseStride;
uniform int poseInstance; // of the first GL instance; POSE_INSTANCED: of the batch's first; POSE_PLACED, POSE_LISTED: in
                          // poseDrawn
uniform int poseInfluences; // the largest number per vertex: 1 to 8

uniform samplerBuffer poseMorphDeltas; // by vertex, target, channel
uniform ivec2 poseMorph;               // number of targets (0: none), the first palette entry of their weights
uniform ivec4 poseMorphChannels;       // channels per target; the index of normal, colour, texture coordinate, or -1
uniform int poseMorphTangents;         // the index of the tangents' channel, or -1

uniform samplerBuffer poseTints; // by instance
uniform bool poseTinted;

uniform float poseOutset; // how far skinned vertices move along their normals, see LodLevels

#ifndef POSE_INFLUENCES
#define POSE_INFLUENCES poseInfluences
#endif
#ifdef POSE_NO_MORPHS
#define POSE_MORPH_TARGETS 0
#else
#define POSE_MORPH_TARGETS poseMorph.x
#endif

in vec4 poseEntries0;
in vec4 poseWeights0;
in vec4 poseEntries1;
in vec4 poseWeights1;

#ifdef POSE_INSTANCED
in vec4 poseInstanceRow0; // the matrix of the GL instance to eye space
in vec4 poseInstanceRow1;
in vec4 poseInstanceRow2;
in vec4 poseInstancePose; // x: its index in the batch

int osgGpuAnimationInstance()
{
    return poseInstance + int(poseInstancePose.x);
}
#elif defined(POSE_PLACED) || defined(POSE_LISTED)
uniform usamplerBuffer poseDrawn; // per GL instance, from poseInstance on: its pose in the batch, its number in the crowd
                                  // with its outfit
uniform samplerBuffer posePlacements; // POSE_PLACED: by number in the crowd: rows at texel number * 3

int osgGpuAnimationInstance()
{
    return int(texelFetch(poseDrawn, poseInstance + gl_InstanceID).x);
}

int osgGpuAnimationPlacement()
{
    return int(texelFetch(poseDrawn, poseInstance + gl_InstanceID).y & POSE_DRAWN_INDEX_MASK);
}

int osgGpuAnimationOutfit()
{
    return int(texelFetch(poseDrawn, poseInstance + gl_InstanceID).y >> POSE_DRAWN_OUTFIT_SHIFT);
}

#ifdef POSE_OUTFIT_PARTS
in float posePart;
uniform uvec4 poseOutfitParts[POSE_OUTFIT_VECTORS];

bool osgGpuAnimationIsShown()
{
    int outfit = osgGpuAnimationOutfit();
    uint parts = poseOutfitParts[outfit / POSE_OUTFITS_PER_VECTOR][outfit % POSE_OUTFITS_PER_VECTOR];
    return (parts >> (uint(posePart + 0.5) & 31u) & 1u) != 0u;
}
#endif

#ifdef POSE_OUTFIT_COLORS
uniform uvec4 poseOutfitColors[POSE_OUTFIT_VECTORS];

vec4 osgGpuAnimationOutfitColor()
{
    int outfit = osgGpuAnimationOutfit();
    uint color = poseOutfitColors[outfit / POSE_OUTFITS_PER_VECTOR][outfit % POSE_OUTFITS_PER_VECTOR];
    return vec4(uvec4(color, color >> 8, color >> 16, color >> 24) & 255u) / 255.0;
}
#endif
#else
int osgGpuAnimationInstance()
{
    return poseInstance + gl_InstanceID;
}
#endif

vec4 osgGpuAnimationTint()
{
#ifdef POSE_PLACED
    vec4 tint = poseTinted ? texelFetch(poseTints, osgGpuAnimationPlacement()) : vec4(1.0);
#else
    vec4 tint = poseTinted ? texelFetch(poseTints, osgGpuAnimationInstance()) : vec4(1.0);
#endif
#ifdef POSE_OUTFIT_COLORS
    tint *= osgGpuAnimationOutfitColor();
#endif
    return tint;
}

mat3x4 osgGpuAnimationEntry(float entry)
{
    int texel = (int(entry) * poseStride + osgGpuAnimationInstance()) * POSE_TEXELS_PER_MATRIX;
    return mat3x4(texelFetch(posePalette, texel), texelFetch(posePalette, texel + 1),
                  texelFetch(posePalette, texel + 2));
}

mat3x4 osgGpuAnimationBlend(vec4 entries, vec4 weights, int influences)
{
    mat3x4 sum = weights.x * osgGpuAnimationEntry(entries.x);
    if (influences > 1) sum += weights.y * osgGpuAnimationEntry(entries.y);
    if (influences > 2) sum += weights.z * osgGpuAnimationEntry(entries.z);
    if (influences > 3) sum += weights.w * osgGpuAnimationEntry(entries.w);
    return sum;
}

float osgGpuAnimationMorphWeight(int target)
{
    int entry = poseMorph.y + target / POSE_WEIGHTS_PER_ENTRY;
    int place = target % POSE_WEIGHTS_PER_ENTRY;
    int texel = (entry * poseStride + osgGpuAnimationInstance()) * POSE_TEXELS_PER_MATRIX;
    return texelFetch(posePalette, texel + place / 4)[place % 4];
}

// The weighted sum of one channel of all targets.
vec4 osgGpuAnimationMorphSum(int channel)
{
    vec4 sum = vec4(0.0);
    for (int target = 0; target < POSE_MORPH_TARGETS; ++target)
    {
        float weight = osgGpuAnimationMorphWeight(target);
        if (weight == 0.0) continue;
        int texel = (gl_VertexID * poseMorph.x + target) * poseMorphChannels.x + channel;
        sum += weight * texelFetch(poseMorphDeltas, texel);
    }
    return sum;
}

void osgGpuAnimationMorphColor(inout vec4 color)
{
    if (POSE_MORPH_TARGETS > 0 && poseMorphChannels.z >= 0)
        color = clamp(color + osgGpuAnimationMorphSum(poseMorphChannels.z), 0.0, 1.0);
}

void osgGpuAnimationMorphTextureCoordinate(inout vec2 coordinate)
{
    if (POSE_MORPH_TARGETS > 0 && poseMorphChannels.w >= 0) coordinate += osgGpuAnimationMorphSum(poseMorphChannels.w).xy;
}

// Transforms normals by the inverse transpose, which is the cofactor matrix divided by the determinant. A mirrored tangent
// frame changes its handedness (w).
void osgGpuAnimationMove(mat3x4 rows, inout vec4 vertex, inout vec3 normal, inout vec4 tangent)
{
    vertex = vec4(vertex * rows, vertex.w);
    vec3 cofactor0 = cross(rows[1].xyz, rows[2].xyz);
    vec3 cofactor1 = cross(rows[2].xyz, rows[0].xyz);
    vec3 cofactor2 = cross(rows[0].xyz, rows[1].xyz);
    vec3 turned = vec3(dot(cofactor0, normal), dot(cofactor1, normal), dot(cofactor2, normal));
    float handedness = dot(rows[0].xyz, cofactor0) < 0.0 ? -1.0 : 1.0;
    normal = handedness * turned;
    tangent = vec4(vec4(tangent.xyz, 0.0) * rows, handedness * tangent.w);
}

// tangent: of glTF 2.0, section 3.7.2.1: w is 1 or -1.
void osgGpuAnimationSkinTangent(inout vec4 vertex, inout vec3 normal, inout vec4 tangent)
{
    if (POSE_MORPH_TARGETS > 0)
    {
        vertex.xyz += osgGpuAnimationMorphSum(0).xyz;
        if (poseMorphChannels.y >= 0) normal += osgGpuAnimationMorphSum(poseMorphChannels.y).xyz;
        if (poseMorphTangents >= 0) tangent.xyz += osgGpuAnimationMorphSum(poseMorphTangents).xyz;
    }
    mat3x4 rows = osgGpuAnimationBlend(poseEntries0, poseWeights0, POSE_INFLUENCES);
    if (POSE_INFLUENCES > 4) rows += osgGpuAnimationBlend(poseEntries1, poseWeights1, POSE_INFLUENCES - 4);
    osgGpuAnimationMove(rows, vertex, normal, tangent);
    if (poseOutset > 0.0) vertex.xyz += poseOutset * inversesqrt(max(dot(normal, normal), 1e-30)) * normal;
#ifdef POSE_INSTANCED
    osgGpuAnimationMove(mat3x4(poseInstanceRow0, poseInstanceRow1, poseInstanceRow2), vertex, normal, tangent);
#elif defined(POSE_PLACED)
    int texel = osgGpuAnimationPlacement() * POSE_TEXELS_PER_MATRIX;
    osgGpuAnimationMove(mat3x4(texelFetch(posePlacements, texel), texelFetch(posePlacements, texel + 1),
                               texelFetch(posePlacements, texel + 2)), vertex, normal, tangent);
#endif
#ifdef POSE_OUTFIT_PARTS
    if (!osgGpuAnimationIsShown()) vertex = vec4(0.0); // triangles with such a vertex have no area
#endif
}

void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal)
{
    vec4 tangent = vec4(0.0);
    osgGpuAnimationSkinTangent(vertex, normal, tangent);
}

#else

vec4 osgGpuAnimationTint()
{
    return vec4(1.0);
}

void osgGpuAnimationMorphColor(inout vec4 color)
{
}

void osgGpuAnimationMorphTextureCoordinate(inout vec2 coordinate)
{
}

void osgGpuAnimationSkinTangent(inout vec4 vertex, inout vec3 normal, inout vec4 tangent)
{
}

void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal)
{
}

#endif
