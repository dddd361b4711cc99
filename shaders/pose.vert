// SPDX-License-Identifier: MIT
// The default pipeline: mix, local and world in one pass, drawn a level at a time over all instances.
// gl_VertexID = entry * instanceCount + instance, which is also the place of the result in the palette.

uniform samplerBuffer parentLevels; // the palette's levels computed so far that hold this level's parents
uniform int instanceCount;
uniform int trackCount;

out vec4 row0;
out vec4 row1;
out vec4 row2;

void main()
{
    int entry = gl_VertexID / instanceCount;
    int instance = gl_VertexID - entry * instanceCount;
    vec4 head = texelFetch(entries, entry * POSE_TEXELS_PER_ENTRY);
    int parent = int(head.x);
    int kind = int(head.z);
    bool isWeights = (kind & POSE_ENTRY_IS_WEIGHTS) != 0;

    mat3x4 matrix = mat3x4(1.0);
    if ((kind & POSE_ENTRY_HAS_TRACK) != 0)
    {
        JointTransform t = mixTrack(instance, int(head.y), trackCount, isWeights);
        matrix = isWeights ? mat3x4(t.translation, t.rotation, t.scale)
                           : localMatrix(t.translation, t.rotation, t.scale);
    }
    if (!isWeights)
    {
        matrix = withParentBind(entry, kind, withInverseBind(entry, kind, matrix));
        matrix = parent < 0 ? rooted(instance, matrix)
                            : multiplied(fetchMatrix(parentLevels, (parent * instanceCount + instance) *
                                                                   POSE_TEXELS_PER_MATRIX), matrix);
    }
    row0 = matrix[0];
    row1 = matrix[1];
    row2 = matrix[2];
}
