// SPDX-License-Identifier: MIT
// Skinning by the palette (glTF 2.0, section 3.7.3.3). Link this shader into a program of one's own, declare
//     void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
// and call it on the vertex and normal of the bind pose; they come back in the character's own space.
// Attributes are bound to the locations of layout.glsl; SkinnedGeometry sets the uniforms when it draws.

uniform samplerBuffer posePalette; // entry e of instance i: rows at texel (e * poseStride + i) * 3
uniform int poseStride;
uniform int poseInstance;
uniform int poseInfluences; // of a vertex, at most: 1 to 8

in vec4 poseEntries0;
in vec4 poseWeights0;
in vec4 poseEntries1;
in vec4 poseWeights1;

mat3x4 osgGpuAnimationEntry(float entry)
{
    int texel = (int(entry) * poseStride + poseInstance) * POSE_TEXELS_PER_MATRIX;
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

void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal)
{
    mat3x4 rows = osgGpuAnimationBlend(poseEntries0, poseWeights0, poseInfluences);
    if (poseInfluences > 4) rows += osgGpuAnimationBlend(poseEntries1, poseWeights1, poseInfluences - 4);
    vertex = vec4(vertex * rows, vertex.w);

    // Normals go by the inverse transpose, which is the cofactor matrix but for the determinant.
    vec3 cofactor0 = cross(rows[1].xyz, rows[2].xyz);
    vec3 cofactor1 = cross(rows[2].xyz, rows[0].xyz);
    vec3 cofactor2 = cross(rows[0].xyz, rows[1].xyz);
    vec3 turned = vec3(dot(cofactor0, normal), dot(cofactor1, normal), dot(cofactor2, normal));
    normal = dot(rows[0].xyz, cofactor0) < 0.0 ? -turned : turned;
}
