// SPDX-License-Identifier: MIT
// The local stage as a separate pass. gl_VertexID = track * instanceCount + instance, which also orders the result.

uniform samplerBuffer mixedTracks; // written by mix.vert
uniform int instanceCount;
uniform int jointCount; // tracks from this index on are weight blocks, which are copied

out vec4 row0;
out vec4 row1;
out vec4 row2;

void main()
{
    int texel = gl_VertexID * POSE_TEXELS_PER_TRANSFORM;
    vec4 translation = texelFetch(mixedTracks, texel);
    vec4 rotation = texelFetch(mixedTracks, texel + 1);
    vec4 scale = texelFetch(mixedTracks, texel + 2);
    bool isWeights = gl_VertexID / instanceCount >= jointCount;
    mat3x4 matrix = isWeights ? mat3x4(translation, rotation, scale) : localMatrix(translation, rotation, scale);
    row0 = matrix[0];
    row1 = matrix[1];
    row2 = matrix[2];
}
