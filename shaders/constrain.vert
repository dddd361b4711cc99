// SPDX-License-Identifier: MIT
// The constrain stage of the default pipeline: the draws before a level solve the constraints whose paths begin at that
// level. The vertices are the batch's instances, and the GL instances are constraints that do not depend on each other.
// It mixes the joints of the path, solves the constraint and writes the rotations of the chain, which pose.vert takes in
// place of the mixed ones. Constants of the variant: those of mix.glsl and constrain.glsl; bool isRootLevel, hasRoots: as
// in pose.vert; int aboveLength: joints of the path above the chain.

layout(location = POSE_SAMPLE_LOCATION) in uvec4 blendSamples[sampleCount > 0 ? sampleCount : 1];
layout(location = POSE_ROOT_LOCATION) in mat3x4 rootMatrix;

uniform samplerBuffer parentLevels; // levels of the palette that include the parent of the path
uniform int firstParent;            // the first entry in parentLevels
uniform int instanceCount;
uniform samplerBuffer entries;      // the static part of the palette entries
uniform samplerBuffer constraints;  // POSE_TEXELS_PER_CONSTRAINT texels, then one per joint of the path
uniform int constraintTexel;        // the first texel of the first constraint
uniform samplerBuffer targets;
uniform int targetStride;           // targets of an instance
uniform samplerBuffer corrections;  // the rotations of the constraints before

out vec4 rotations[chainLength];

uvec4 sampleOf(int instance, int number)
{
    return sampleCount > 0 ? blendSamples[number] : texelFetch(samples, instance * sampleStride + number);
}

vec4 constraintNumbers(int number)
{
    const int texels = POSE_TEXELS_PER_CONSTRAINT + aboveLength + chainLength;
    return texelFetch(constraints, constraintTexel + gl_InstanceID * texels + number);
}

vec4 pathJoint(int place)
{
    return constraintNumbers(POSE_TEXELS_PER_CONSTRAINT + place);
}

float shareOf(int joint)
{
    return pathJoint(aboveLength + joint).z;
}

JointTransform mixedJoint(int place)
{
    vec4 joint = pathJoint(place);
    const RestParts none = RestParts(vec4(0.0), vec4(0.0)); // no part is POSE_PART_FIXED here
    JointTransform t = hasSeveralSamples ? mixSamples(gl_VertexID, int(joint.x), none, false)
                                         : sampleTrack(blendSamples[0], int(joint.x), none, false);
    int code = int(joint.y);
    if (code > 0) t.rotation = texelFetch(corrections, correctionTexel(code, gl_VertexID, instanceCount));
    return t;
}

mat3x4 pathParentToModel(vec4 head, int entryTexel)
{
    if (isRootLevel) return hasRoots ? rootMatrix : mat3x4(1.0);
    int texel = ((int(head.x) - firstParent) * instanceCount + gl_VertexID) * POSE_TEXELS_PER_MATRIX;
    return multiplied(fetchMatrix(parentLevels, texel), fetchMatrix(entries, entryTexel + 1));
}

void main()
{
    vec4 head = constraintNumbers(0);
    vec4 target[POSE_TEXELS_PER_TARGET];
    for (int i = 0; i < POSE_TEXELS_PER_TARGET; ++i)
        target[i] = texelFetch(targets, (gl_VertexID * targetStride + int(head.y)) * POSE_TEXELS_PER_TARGET + i);
    int entryTexel = int(head.x) * POSE_TEXELS_PER_ENTRY;
    mat3x4 toModel = pathParentToModel(texelFetch(entries, entryTexel), entryTexel);
    for (int place = 0; place < aboveLength; ++place)
    {
        JointTransform above = mixedJoint(place);
        toModel = multiplied(toModel, localMatrix(above.translation, above.rotation, above.scale));
    }
    vec4 mixed[chainLength];
    for (int joint = 0; joint < chainLength; ++joint)
    {
        chain[joint] = mixedJoint(aboveLength + joint);
        mixed[joint] = chain[joint].rotation;
        rotations[joint] = mixed[joint];
    }
    if (!(target[0].w > 0.0) || !hasInverse(toModel)) return;

    mat3 toParent = inverse(mat3(toModel));
    Goal goal = Goal((target[0].xyz - originOf(toModel)) * toParent, target[1].xyz * toParent, target[1].w);
    bool isSolved = false;
    vec4 first = constraintNumbers(1);
    if (isLookAt)
    {
        vec4 up = constraintNumbers(2);
        isSolved = solveLookAt(LookAt(first.xyz, up.xyz, constraintNumbers(3).xyz, first.w, up.w), goal);
    }
    else
        isSolved = solveTwoBone(first.xyz, first.w, goal);
    if (!isSolved) return;
    if (!isLookAt && target[2] != vec4(0.0)) orient(target[2], toParent);
    for (int joint = 0; joint < chainLength; ++joint)
        rotations[joint] = slerpShortest(mixed[joint], chain[joint].rotation, target[0].w);
}
