// SPDX-License-Identifier: MIT
// The mix stage as a separate pass. gl_VertexID = track * instanceCount + instance, which also orders the result.

uniform int instanceCount;
uniform int jointCount; // tracks from this index on are weight blocks

out vec4 translation;
out vec4 rotation;
out vec4 scale;

uvec4 sampleOf(int instance, int number)
{
    return texelFetch(samples, instance * sampleStride + number);
}

void main()
{
    int track = gl_VertexID / instanceCount;
    int instance = gl_VertexID - track * instanceCount;
    bool isWeights = hasWeights && track >= jointCount;
    const RestParts none = RestParts(vec4(0.0), vec4(0.0)); // no part is POSE_PART_FIXED here
    JointTransform t = hasSeveralSamples ? mixSamples(instance, track, none, isWeights)
                                         : sampleTrack(texelFetch(samples, instance), track, none, isWeights);
    translation = t.translation;
    rotation = t.rotation;
    scale = t.scale;
}
