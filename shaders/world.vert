// SPDX-License-Identifier: MIT
// The world stage as a separate pass, in one draw: each entry multiplies its ancestors, so it costs O(depth).
// gl_VertexID = entry * instanceCount + instance, which also orders the result.

uniform samplerBuffer entries; // the static part of the palette entries, POSE_TEXELS_PER_ENTRY texels per entry
uniform samplerBuffer roots;   // a 3x4 matrix per instance, or one for all
uniform int rootCount;         // 0: none
uniform samplerBuffer localMatrices; // written by local.vert: matrix track * instanceCount + instance
uniform int instanceCount;

out vec4 row0;
out vec4 row1;
out vec4 row2;

mat3x4 localOf(int track, int instance)
{
    return limitedLocal(fetchMatrix(localMatrices, (track * instanceCount + instance) * POSE_TEXELS_PER_MATRIX));
}

void main()
{
    int entry = gl_VertexID / instanceCount;
    int instance = gl_VertexID - entry * instanceCount;
    vec4 head = texelFetch(entries, entry * POSE_TEXELS_PER_ENTRY);
    mat3x4 matrix = head.y >= 0.0 ? localOf(int(head.y), instance) : mat3x4(1.0);
    if (head.z == 0.0)
    {
        matrix = multiplied(matrix, fetchMatrix(entries, entry * POSE_TEXELS_PER_ENTRY + 4));
        for (int parent = int(head.x); parent >= 0; parent = int(head.x))
        {
            head = texelFetch(entries, parent * POSE_TEXELS_PER_ENTRY);
            if (head.y >= 0.0) matrix = multiplied(localOf(int(head.y), instance), matrix);
        }
        if (rootCount > 0)
            matrix = multiplied(fetchMatrix(roots, min(instance, rootCount - 1) * POSE_TEXELS_PER_MATRIX), matrix);
    }
    row0 = matrix[0];
    row1 = matrix[1];
    row2 = matrix[2];
}
