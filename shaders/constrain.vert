// SPDX-License-Identifier: MIT
// The constrain stage of the default pipeline: the draws before a level solve the constraints whose paths begin at that
// level, one draw each. The vertices are the batch's instances. It mixes the joints of the path, solves the constraint and
// writes the rotations of the chain, which pose.vert takes in place of the mixed ones. The constraint's constants are
// uniforms, since llvmpipe fetches texels for each vertex. Constants of the variant: those of mix.glsl and constrain.glsl; bool isRootLevel, hasRoots: as
// in pose.vert; int aboveLength: joints of the path above the chain.

layout(location = POSE_SAMPLE_LOCATION) in uvec4 blendSamples[sampleCount > 0 ? sampleCount : 1];
layout(location = POSE_ROOT_LOCATION) in mat3x4 rootMatrix;

uniform samplerBuffer parentLevels; // levels of the palette that include the parent of the path
uniform int firstParent;            // the first entry in parentLevels
uniform int instanceCount;
uniform vec4 constraint[POSE_TEXELS_PER_CONSTRAINT + POSE_TEXELS_PER_CHAIN_JOINT * chainLength];
uniform samplerBuffer jointsAbove;  // joints of all paths above their chains: track, code of the correction
uniform int firstAbove;             // the first of this path
uniform samplerBuffer targets;
uniform int targetStride;           // targets of an instance
uniform samplerBuffer corrections;  // the rotations of the constraints before

out vec4 rotations[chainLength];

uvec4 sampleOf(int instance, int number)
{
    return sampleCount > 0 ? blendSamples[number] : texelFetch(samples, instance * sampleStride + number);
}

vec4 chainTexel(int joint, int number)
{
    return constraint[POSE_TEXELS_PER_CONSTRAINT + POSE_TEXELS_PER_CHAIN_JOINT * joint + number];
}

float shareOf(int joint)
{
    return chainTexel(joint, 0).z;
}

JointTransform mixedJoint(vec4 joint, RestParts rest)
{
    JointTransform t = hasSeveralSamples ? mixSamples(gl_VertexID, int(joint.x), rest, false)
                                         : sampleTrack(blendSamples[0], int(joint.x), rest, false);
    if (!hasSources) return t;
    int code = int(joint.y);
    if (code > 0) t.rotation = texelFetch(corrections, correctionTexel(code, gl_VertexID, instanceCount));
    return t;
}

mat3x4 pathParentToModel()
{
    if (isRootLevel) return hasRoots ? rootMatrix : mat3x4(1.0);
    int texel = ((int(constraint[0].x) - firstParent) * instanceCount + gl_VertexID) * POSE_TEXELS_PER_MATRIX;
    return multiplied(fetchMatrix(parentLevels, texel), mat3x4(constraint[1], constraint[2], constraint[3]));
}

void main()
{
    vec4 target[POSE_TEXELS_PER_TARGET];
    for (int i = 0; i < POSE_TEXELS_PER_TARGET; ++i)
        target[i] = texelFetch(targets, (gl_VertexID * targetStride + int(constraint[0].y)) * POSE_TEXELS_PER_TARGET + i);
    mat3x4 toModel = pathParentToModel();
    for (int place = 0; place < aboveLength; ++place)
    {
        vec4 joint = texelFetch(jointsAbove, firstAbove + place);
        JointTransform atRest = fetchRest(int(joint.x));
        JointTransform above = mixedJoint(joint, RestParts(atRest.translation, atRest.scale));
        toModel = multiplied(toModel, localOf(above));
    }
    vec4 mixed[chainLength];
    for (int joint = 0; joint < chainLength; ++joint)
    {
        chain[joint] = mixedJoint(chainTexel(joint, 0), RestParts(chainTexel(joint, 1), chainTexel(joint, 2)));
        mixed[joint] = chain[joint].rotation;
        rotations[joint] = mixed[joint];
    }
    mat3 toParent;
    if (!invert(toModel, toParent) || !(target[0].w > 0.0)) return;

    Goal goal = Goal((target[0].xyz - originOf(toModel)) * toParent, vec3(0.0), 0.0);
    if (hasDirections)
    {
        goal.pole = target[1].xyz * toParent;
        goal.twist = target[1].w;
    }
    bool isSolved = false;
    vec4 first = constraint[4];
    vec4 up = constraint[5];
    if (isLookAt) isSolved = solveLookAt(LookAt(first.xyz, up.xyz, constraint[6].xyz, first.w, up.w), goal);
    else isSolved = solveTwoBone(first.xyz, first.w, goal);
    if (!isSolved) return;
    if (!isLookAt && hasDirections && target[2] != vec4(0.0)) orient(target[2], toParent);
    for (int joint = 0; joint < chainLength; ++joint)
        rotations[joint] = hasFractions ? slerpShortest(mixed[joint], chain[joint].rotation, target[0].w)
                                        : chain[joint].rotation;
}
