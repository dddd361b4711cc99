// SPDX-License-Identifier: MIT
// The world stage as a pass of its own, in one draw: each entry walks up its ancestors, so it costs O(depth).
// gl_VertexID = entry * instanceCount + instance, also in the result.

uniform samplerBuffer localMatrices; // what local.vert wrote: matrix track * instanceCount + instance
uniform int instanceCount;

out vec4 row0;
out vec4 row1;
out vec4 row2;

mat3x4 localOf(int track, int instance)
{
    return fetchMatrix(localMatrices, (track * instanceCount + instance) * POSE_TEXELS_PER_MATRIX);
}

void main()
{
    int entry = gl_VertexID / instanceCount;
    int instance = gl_VertexID - entry * instanceCount;
    vec4 head = texelFetch(entries, entry * POSE_TEXELS_PER_ENTRY);
    int kind = int(head.z);

    mat3x4 matrix = mat3x4(1.0);
    if ((kind & POSE_ENTRY_HAS_TRACK) != 0) matrix = localOf(int(head.y), instance);
    if ((kind & POSE_ENTRY_IS_WEIGHTS) == 0)
    {
        matrix = withInverseBind(entry, kind, matrix);
        for (int parent = int(head.x); parent >= 0;)
        {
            head = texelFetch(entries, parent * POSE_TEXELS_PER_ENTRY);
            if ((int(head.z) & POSE_ENTRY_HAS_TRACK) != 0) matrix = multiplied(localOf(int(head.y), instance), matrix);
            parent = int(head.x);
        }
        matrix = rooted(instance, matrix);
    }
    row0 = matrix[0];
    row1 = matrix[1];
    row2 = matrix[2];
}
