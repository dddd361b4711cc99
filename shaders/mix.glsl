// SPDX-License-Identifier: MIT
// Stage 1, mix: a track's joint transform from the two keyframes of each blend sample of its instance.

// The program's variant says by constants what a batch needs, since some drivers run both sides of every branch:
// const bool hasSplines, hasSeveralSamples, hasWeights.

uniform samplerBuffer keyframes;  // joint transforms, all clips of the set one after another
uniform usamplerBuffer samples;   // sampleStride blend samples an instance
uniform int sampleStride;

struct JointTransform
{
    vec4 translation;
    vec4 rotation; // unit quaternion x, y, z, w
    vec4 scale;
};

JointTransform fetchTransform(int index)
{
    int texel = index * POSE_TEXELS_PER_TRANSFORM;
    return JointTransform(texelFetch(keyframes, texel), texelFetch(keyframes, texel + 1),
                          texelFetch(keyframes, texel + 2));
}

// sin(x) / x for x * x in [0, (pi / 2)^2], to 4e-9.
float sinc(float xx)
{
    return 0.999999996 + xx * (-0.16666658 + xx * (0.00833305062 + xx * (-0.000198090464 + xx * 2.60516628e-06)));
}

// Slerp the short way (glTF 2.0, appendix C.4), to 1.4e-7 in any driver: built-in acos and sin are coarse in some.
// With u = |a - b|^2 / |a + b|^2 = tan^2(angle / 2), angle^2 is a smooth function of u, fitted on [0, 1]; sines are
// divided by the angle, so that nothing breaks where it is 0.
vec4 slerpShortest(vec4 a, vec4 b, float alpha)
{
    if (dot(a, b) < 0.0) b = -b;
    vec4 difference = a - b;
    vec4 sum = a + b;
    float u = dot(difference, difference) / dot(sum, sum);
    float angleSquared = u * (3.99999852 + u * (-2.66646802 + u * (2.03998423 + u * (-1.63703396 +
                         u * (1.25359431 + u * (-0.786993173 + u * (0.328773701 - u * 0.0644555844)))))));
    float beta = 1.0 - alpha;
    return normalize(beta * sinc(beta * beta * angleSquared) * a + alpha * sinc(alpha * alpha * angleSquared) * b);
}

JointTransform interpolate(JointTransform a, JointTransform b, float alpha, bool isWeights)
{
    return JointTransform(mix(a.translation, b.translation, alpha),
                          isWeights ? mix(a.rotation, b.rotation, alpha) : slerpShortest(a.rotation, b.rotation, alpha),
                          mix(a.scale, b.scale, alpha));
}

// Hermite form (glTF 2.0, appendix C.5); tangents are scaled by the interval already.
JointTransform interpolateSpline(JointTransform a, JointTransform aOut, JointTransform bIn, JointTransform b,
                                 float alpha, bool isWeights)
{
    float alpha2 = alpha * alpha;
    float alpha3 = alpha2 * alpha;
    vec4 h = vec4(2.0 * alpha3 - 3.0 * alpha2 + 1.0, alpha3 - 2.0 * alpha2 + alpha, alpha3 - alpha2,
                  3.0 * alpha2 - 2.0 * alpha3);
    vec4 rotation = h.x * a.rotation + h.y * aOut.rotation + h.z * bIn.rotation + h.w * b.rotation;
    bool slerped = a.translation.w == 1.0 && !isWeights;
    if (!isWeights) rotation = slerped ? slerpShortest(a.rotation, b.rotation, alpha) : normalize(rotation);
    return JointTransform(h.x * a.translation + h.y * aOut.translation + h.z * bIn.translation + h.w * b.translation,
                          rotation, h.x * a.scale + h.y * aOut.scale + h.z * bIn.scale + h.w * b.scale);
}

JointTransform sampleTrack(uvec4 blendSample, int track, int trackCount, bool isWeights)
{
    int first = int(blendSample.x);
    float alpha = uintBitsToFloat(blendSample.y);
    if (!hasSplines || (blendSample.w & POSE_SAMPLE_SPLINE) == 0u)
    {
        int index = first + track;
        return interpolate(fetchTransform(index), fetchTransform(index + trackCount), alpha, isWeights);
    }
    int index = first + 3 * track;
    int next = index + 3 * trackCount;
    return interpolateSpline(fetchTransform(index), fetchTransform(index + 2), fetchTransform(next + 1),
                             fetchTransform(next), alpha, isWeights);
}

// Several samples: weighted sums; rotations on the hemisphere of the first, made unit; what the weights lack of 1 is
// filled with the rest pose, which is the set's first keyframe.
JointTransform mixSamples(int instance, int track, int trackCount, bool isWeights)
{
    JointTransform sum = JointTransform(vec4(0.0), vec4(0.0), vec4(0.0));
    float lacking = 1.0;
    for (int i = 0; i <= sampleStride; ++i)
    {
        bool isRest = i == sampleStride;
        uvec4 blendSample = isRest ? uvec4(0u) : texelFetch(samples, instance * sampleStride + i);
        float weight = isRest ? max(lacking, 0.0) : uintBitsToFloat(blendSample.z);
        if (weight < 1e-6) continue;
        JointTransform t = sampleTrack(blendSample, track, trackCount, isWeights);
        float side = !isWeights && dot(sum.rotation, t.rotation) < 0.0 ? -weight : weight;
        sum.translation += weight * t.translation;
        sum.rotation += side * t.rotation;
        sum.scale += weight * t.scale;
        lacking -= weight;
    }
    if (!isWeights) sum.rotation = normalize(sum.rotation);
    return sum;
}
