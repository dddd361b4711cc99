// SPDX-License-Identifier: MIT
// The default pipeline: mix, local and world in one pass, with one draw per level of the hierarchy. The vertices of a draw
// are the batch's instances, and its GL instances are the level's palette entries. Data of an instance or an entry are
// attributes, so that the shader fetches keyframes and parents only. The result's place in the palette is
// entry * instanceCount + instance. Constants of the variant: those of mix.glsl and world.glsl; bool isRootLevel, hasRoots;
// bool hasCorrections: constraints have corrected the rotations of all entries of the draw, so none is mixed.

layout(location = POSE_SAMPLE_LOCATION) in uvec4 blendSamples[sampleCount > 0 ? sampleCount : 1];
layout(location = POSE_ROOT_LOCATION) in mat3x4 rootMatrix;
layout(location = POSE_HEAD_LOCATION) in vec4 head;
layout(location = POSE_PARENT_BIND_LOCATION) in mat3x4 parentBind;
layout(location = POSE_INVERSE_BIND_LOCATION) in mat3x4 inverseBind;
layout(location = POSE_REST_LOCATION) in vec4 restParts[2]; // translation, scale

uniform samplerBuffer parentLevels; // levels of the palette that include this level's parents
uniform int firstParent;            // the first entry in parentLevels
uniform int instanceCount;
uniform samplerBuffer corrections;  // see constrain.vert

out vec4 row0;
out vec4 row1;
out vec4 row2;

uvec4 sampleOf(int instance, int number)
{
    return sampleCount > 0 ? blendSamples[number] : texelFetch(samples, instance * sampleStride + number);
}

void main()
{
    int parent = int(head.x);
    int track = int(head.y);
    bool isWeights = hasWeights && head.z != 0.0;

    mat3x4 matrix = mat3x4(1.0);
    if (track >= 0)
    {
        RestParts rest = RestParts(restParts[0], restParts[1]);
        JointTransform t = hasSeveralSamples ? mixSamples(gl_VertexID, track, rest, isWeights)
                                             : sampleTrack(blendSamples[0], track, rest, isWeights);
        if (hasCorrections)
            t.rotation = texelFetch(corrections, correctionTexel(int(head.w), gl_VertexID, instanceCount));
        matrix = isWeights ? mat3x4(t.translation, t.rotation, t.scale)
                           : limitedLocal(localMatrix(t.translation, t.rotation, t.scale));
    }
    if (!isWeights)
    {
        matrix = multiplied(parentBind, multiplied(matrix, inverseBind));
        if (!isRootLevel)
            matrix = multiplied(fetchMatrix(parentLevels, ((parent - firstParent) * instanceCount + gl_VertexID) *
                                                          POSE_TEXELS_PER_MATRIX), matrix);
        else if (hasRoots)
            matrix = multiplied(rootMatrix, matrix);
    }
    row0 = matrix[0];
    row1 = matrix[1];
    row2 = matrix[2];
}
