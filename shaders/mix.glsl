// SPDX-License-Identifier: MIT
// Stage 1, mix: computes a track's joint transform from the two keyframes of each blend sample of its instance.

// Constants of the program variant select the features of a batch, since some drivers run both sides of every branch:
// const bool hasSplines, hasSeveralSamples, hasWeights, hasLayers, hasMasks, hasAdditive, hasPosed; hasExactKeys, hasCompactKeys:
// the formats of the moving parts; const int translationMotion, scaleMotion: POSE_PART_FIXED ...;
// const int sampleCount: blend samples per instance, if few; 0: use sampleStride.

uniform usamplerBuffer keyframes; // of all clips of the set, see animation/keyframes/PackedKeyframes.h
uniform int restTexel;            // of the rest pose in keyframes, POSE_TEXELS_PER_TRANSFORM per track
uniform usamplerBuffer samples;   // sampleStride blend samples per instance
uniform int sampleStride;
uniform samplerBuffer masks;      // maskStride texels per mask
uniform int maskStride;
uniform usamplerBuffer posedKeyframes; // trackCount transforms per keyframe, see animation/keyframes/PosedKeyframe.h
uniform int firstPosed;                // the number of the first of them
uniform int trackCount;

struct JointTransform
{
    vec4 translation;
    vec4 rotation; // unit quaternion x, y, z, w
    vec4 scale;
};

// The translation and scale of a track at rest, used if their motion is POSE_PART_FIXED.
struct RestParts
{
    vec4 translation;
    vec4 scale;
};

JointTransform fetchRest(int track)
{
    int texel = restTexel + track * POSE_TEXELS_PER_TRANSFORM;
    return JointTransform(uintBitsToFloat(texelFetch(keyframes, texel)),
                          uintBitsToFloat(texelFetch(keyframes, texel + 1)),
                          uintBitsToFloat(texelFetch(keyframes, texel + 2)));
}

// The places of a track's values in two keyframes.
struct TrackPlace
{
    uvec4 parts; // places of rotation, translation, scale; w: texel of the vectors of a compact track, 0: exact
    uint first;  // the places of the keyframes' records
    uint second;
};

TrackPlace placeOf(uvec4 blendSample, int track)
{
    uvec4 keyframe = texelFetch(keyframes, int(blendSample.x));
    return TrackPlace(texelFetch(keyframes, int(keyframe.z) + track), keyframe.x, keyframe.y);
}

bool isConstant(uint part)
{
    return (part & POSE_ADDRESS_IS_CONSTANT) != 0u;
}

uint placeIn(uint record, uint part)
{
    return isConstant(part) ? part & ~POSE_ADDRESS_IS_CONSTANT : record + part;
}

// Three numbers of these counts of bits, the first one from that bit of the texel on; then the two bits after them. They are
// signed since processors without a conversion from unsigned integers to floats take several instructions for it.
ivec4 packedNumbers(uvec4 texel, uint bit, uvec3 bits)
{
    uint word = bit >> 5;
    uint shift = bit & 31u;
    uvec3 words = word == 0u ? texel.xyz : word == 1u ? texel.yzw : word == 2u ? uvec3(texel.zw, 0u) : uvec3(texel.w, 0u, 0u);
    uvec3 masks = (uvec3(1u) << bits) - 1u;
    uint low = (words.x >> shift) | (words.y << 1 << (31u - shift));
    uint high = (words.y >> shift) | (words.z << 1 << (31u - shift));
    uint second = (low >> bits.x) | (high << 1 << (31u - bits.x));
    uint third = (second >> bits.y) | (high >> bits.x << 1 << (31u - bits.y));
    return ivec4(uvec4(uvec3(low, second, third) & masks, third >> bits.z & 3u));
}

vec4 packedRotation(uvec4 texel, uvec3 parts)
{
    uvec3 bits = (parts >> POSE_ROTATION_BITS_SHIFT) & 31u;
    ivec4 numbers = packedNumbers(texel, parts.y >> POSE_ROTATION_PLACE_SHIFT, bits);
    ivec3 ranges = ivec3(parts & 0xFFFFFu);
    vec3 least = vec3(ranges & 1023) * POSE_ROTATION_RANGE_UNIT - 1.0;
    vec3 extent = (vec3(ranges >> 10) + 1.0) * POSE_ROTATION_RANGE_UNIT;
    vec3 power = uintBitsToFloat((127u - bits) << 23); // 2^-bits
    vec3 v = mix(least + extent * power * (vec3(numbers.xyz) + 0.5), vec3(ranges) * POSE_ROTATION_FINE_UNIT - 1.0,
                 equal(bits, uvec3(0u)));
    float rest = sqrt(max(1.0 - dot(v, v), 0.0));
    uint omitted = parts.z >> POSE_ROTATION_PLACE_SHIFT & 7u;
    if (omitted == POSE_ROTATION_LARGEST) omitted = uint(numbers.w);
    return vec4(omitted == 0u ? rest : v.x, omitted == 1u ? rest : (omitted == 0u ? v.x : v.y),
                omitted == 2u ? rest : (omitted == 3u ? v.z : v.y), omitted == 3u ? rest : v.z);
}

vec4 rotationIn(uint record, TrackPlace track)
{
    bool isCompact = hasCompactKeys && !isConstant(track.parts.x) && (!hasExactKeys || track.parts.w != 0u);
    uint part = isCompact ? (track.parts.x >> POSE_ROTATION_PLACE_SHIFT) | (track.parts.z >> POSE_ROTATION_HIGH_SHIFT << 6)
                          : track.parts.x;
    uvec4 texel = texelFetch(keyframes, int(placeIn(record, part)));
    vec4 exact = uintBitsToFloat(texel);
    return isCompact ? packedRotation(texel, track.parts.xyz) : exact;
}

vec3 vectorIn(uint record, uvec4 first, uvec4 second)
{
    uvec3 bits = (second.www >> uvec3(0u, POSE_VECTOR_BITS, 2 * POSE_VECTOR_BITS)) & 31u;
    uint bit = first.w & ~POSE_VECTOR_MOVES;
    uvec4 texel = texelFetch(keyframes, int(record + (bit >> 7)));
    return uintBitsToFloat(first.xyz) + uintBitsToFloat(second.xyz) * vec3(packedNumbers(texel, bit & 127u, bits).xyz);
}

// A translation (0) or scale (1). part: its place, if the track is exact.
vec4 mixedPart(TrackPlace track, uint part, uint number, float alpha, int motion)
{
    bool isCompact = hasCompactKeys && track.parts.w != 0u;
    uint place = isCompact ? track.parts.w + number : placeIn(track.first, part);
    uvec4 texel = texelFetch(keyframes, int(place));
    vec4 a = uintBitsToFloat(texel);
    if (motion == POSE_PART_CONSTANT) return a;
    if (isCompact && (texel.w & POSE_VECTOR_MOVES) != 0u)
    {
        uvec4 second = texelFetch(keyframes, int(place + 2u));
        return vec4(mix(vectorIn(track.first, texel, second), vectorIn(track.second, texel, second), alpha), 0.0);
    }
    if (!hasExactKeys || isCompact) return a;
    return mix(a, uintBitsToFloat(texelFetch(keyframes, int(placeIn(track.second, part)))), alpha);
}

// sin(x) / x for x * x in [0, (pi / 2)^2], to 4e-9.
float sinc(float xx)
{
    return 0.999999996 + xx * (-0.16666658 + xx * (0.00833305062 + xx * (-0.000198090464 + xx * 2.60516628e-06)));
}

// For unit vectors u = |a - b|^2 / |a + b|^2 is tan^2(angle / 2), and angle^2 / 4 is a smooth function of u. This fit on
// [0, 1] has an error of 1.4e-7 in every driver, while built-in acos and sin are inaccurate in some.
float quarterSquared(float u)
{
    return u * (0.99999963 + u * (-0.666617055 + u * (0.509996058 + u * (-0.40925846 +
           u * (0.313398578 + u * (-0.196748293 + u * (0.0821934253 - u * 0.0161138961)))))));
}

// Slerp along the shorter arc (glTF 2.0, appendix C.4). Sines are divided by the angle, so that an angle of 0 is valid.
vec4 slerpShortest(vec4 a, vec4 b, float alpha)
{
    if (dot(a, b) < 0.0) b = -b;
    vec4 difference = a - b;
    vec4 sum = a + b;
    float angleSquared = 4.0 * quarterSquared(dot(difference, difference) / dot(sum, sum));
    float beta = 1.0 - alpha;
    return normalize(beta * sinc(beta * beta * angleSquared) * a + alpha * sinc(alpha * alpha * angleSquared) * b);
}

JointTransform interpolate(TrackPlace track, RestParts rest, float alpha, bool isWeights)
{
    vec4 a = rotationIn(track.first, track);
    vec4 b = rotationIn(track.second, track);
    vec4 rotation = isWeights ? mix(a, b, alpha) : slerpShortest(a, b, alpha);
    return JointTransform(
        translationMotion == POSE_PART_FIXED ? rest.translation
                                             : mixedPart(track, track.parts.y, 0u, alpha, translationMotion),
        rotation,
        scaleMotion == POSE_PART_FIXED ? rest.scale : mixedPart(track, track.parts.z, 1u, alpha, scaleMotion));
}

// A part of a spline keyframe: its value (0), in-tangent (1) or out-tangent (2). Constant parts have tangents of 0.
vec4 splinePart(uint record, uint part, uint tangent)
{
    vec4 number = uintBitsToFloat(texelFetch(keyframes, int(placeIn(record, part)) + (isConstant(part) ? 0 : int(tangent))));
    return tangent != 0u && isConstant(part) ? vec4(0.0) : number;
}

vec4 hermite(TrackPlace track, uint part, vec4 h)
{
    return h.x * splinePart(track.first, part, 0u) + h.y * splinePart(track.first, part, 2u) +
           h.z * splinePart(track.second, part, 1u) + h.w * splinePart(track.second, part, 0u);
}

// Hermite form (glTF 2.0, appendix C.5); the tangents are already scaled by the interval.
JointTransform interpolateSpline(TrackPlace track, RestParts rest, float alpha, bool isWeights)
{
    float alpha2 = alpha * alpha;
    float alpha3 = alpha2 * alpha;
    vec4 h = vec4(2.0 * alpha3 - 3.0 * alpha2 + 1.0, alpha3 - 2.0 * alpha2 + alpha, alpha3 - alpha2,
                  3.0 * alpha2 - 2.0 * alpha3);
    vec4 translation = rest.translation;
    if (translationMotion != POSE_PART_FIXED) translation = hermite(track, track.parts.y, h);
    // A flag: 1 if the rotation is slerped.
    float mark = translationMotion == POSE_PART_FIXED ? rest.translation.w : splinePart(track.first, track.parts.y, 0u).w;
    vec4 rotation = hermite(track, track.parts.x, h);
    vec4 slerped = slerpShortest(splinePart(track.first, track.parts.x, 0u), splinePart(track.second, track.parts.x, 0u),
                                 alpha);
    if (!isWeights) rotation = mark == 1.0 ? slerped : normalize(rotation);
    return JointTransform(translation, rotation,
                          scaleMotion == POSE_PART_FIXED ? rest.scale : hermite(track, track.parts.z, h));
}

JointTransform sampleTrack(uvec4 blendSample, int track, RestParts rest, bool isWeights)
{
    float alpha = uintBitsToFloat(blendSample.y);
    TrackPlace place = placeOf(blendSample, track);
    if (!hasSplines || (blendSample.w & POSE_SAMPLE_SPLINE) == 0u) return interpolate(place, rest, alpha, isWeights);
    return interpolateSpline(place, rest, alpha, isWeights);
}

// A part of a posed keyframe. A number that is not set is 0, and so is its cover; the cover of the others is 1.
vec4 posedPart(int texel, out vec4 cover)
{
    uvec4 words = texelFetch(posedKeyframes, texel);
    uvec4 isSet = uvec4(notEqual(words, uvec4(POSE_NOT_SET)));
    cover = vec4(isSet);
    return uintBitsToFloat(words * isSet);
}

JointTransform posedTrack(uvec4 blendSample, int track, out JointTransform cover)
{
    int texel = ((int(blendSample.x) - firstPosed) * trackCount + track) * POSE_TEXELS_PER_TRANSFORM;
    JointTransform t;
    t.translation = posedPart(texel, cover.translation);
    t.rotation = posedPart(texel + 1, cover.rotation);
    t.scale = posedPart(texel + 2, cover.scale);
    return t;
}

float maskWeight(uint control, int track)
{
    return texelFetch(masks, int(control >> POSE_SAMPLE_MASK_SHIFT) * maskStride + track / POSE_WEIGHTS_PER_MASK_TEXEL)
                     [track % POSE_WEIGHTS_PER_MASK_TEXEL];
}

void addScaled(inout JointTransform sum, JointTransform t, float factor)
{
    sum.translation += factor * t.translation;
    sum.rotation += factor * t.rotation;
    sum.scale += factor * t.scale;
}

vec4 coveredPart(vec4 below, vec4 group, vec4 weight)
{
    return (1.0 - min(weight, 1.0)) * below + group / max(weight, 1.0);
}

// The weighted sum of one blend priority over the result of the lower ones. weights: of each number, used with posed samples.
JointTransform covered(JointTransform below, JointTransform group, float weight, JointTransform weights, bool isWeights)
{
    if (!isWeights && dot(below.rotation, group.rotation) < 0.0) below.rotation = -below.rotation;
    if (hasPosed) return JointTransform(coveredPart(below.translation, group.translation, weights.translation),
                                        coveredPart(below.rotation, group.rotation, weights.rotation),
                                        coveredPart(below.scale, group.scale, weights.scale));
    float left = 1.0 - min(weight, 1.0);
    JointTransform sum = JointTransform(left * below.translation, left * below.rotation, left * below.scale);
    addScaled(sum, group, 1.0 / max(weight, 1.0));
    return sum;
}

vec4 quaternionProduct(vec4 a, vec4 b)
{
    return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

// The logarithm of a unit quaternion: axis times half the angle, along the shorter arc.
vec3 quaternionLogarithm(vec4 q)
{
    if (q.w < 0.0) q = -q;
    float vv = dot(q.xyz, q.xyz);
    return q.xyz / sinc(4.0 * quarterSquared((vv + (1.0 - q.w) * (1.0 - q.w)) / (vv + (1.0 + q.w) * (1.0 + q.w))));
}

// The inverse of the logarithm for |v| <= pi: the rotation by a quarter, doubled twice, so that cosines stay above 0.
vec4 quaternionExponential(vec3 v)
{
    v *= 0.25;
    vec3 sine = v * sinc(dot(v, v));
    vec4 q = vec4(sine, sqrt(1.0 - dot(sine, sine)));
    for (int i = 0; i < 2; ++i)
        q = vec4(2.0 * q.w * q.xyz, 1.0 - 2.0 * dot(q.xyz, q.xyz));
    return q;
}

// The sum of additive differences: translations (and whole weight blocks), logarithms of rotations, scale factors.
struct Difference
{
    JointTransform sum;
    vec3 turn;
    vec3 growth;
};

// Numbers that the sample has not are those of the reference: they change nothing.
JointTransform completed(JointTransform t, JointTransform reference, JointTransform cover)
{
    return JointTransform(mix(reference.translation, t.translation, cover.translation),
                          mix(reference.rotation, t.rotation, cover.rotation),
                          mix(reference.scale, t.scale, cover.scale));
}

void addDifference(inout Difference difference, JointTransform reference, JointTransform t, float weight)
{
    addScaled(difference.sum, t, weight);
    addScaled(difference.sum, reference, -weight);
    vec4 inverse = vec4(-reference.rotation.xyz, reference.rotation.w);
    difference.turn += weight * quaternionLogarithm(quaternionProduct(inverse, t.rotation));
    vec3 size = reference.scale.xyz;
    vec3 isKept = vec3(lessThanEqual(abs(size), vec3(POSE_SMALLEST_SCALE)));
    difference.growth *= 1.0 + weight * (1.0 - isKept) * (t.scale.xyz / (size + isKept) - 1.0);
}

JointTransform changed(JointTransform t, Difference difference, bool isWeights)
{
    if (isWeights)
    {
        addScaled(t, difference.sum, 1.0);
        return t;
    }
    const float pi = 3.14159265;
    float turned = length(difference.turn);
    vec3 turn = difference.turn * (turned > pi ? pi / turned : 1.0);
    return JointTransform(t.translation + difference.sum.translation,
                          quaternionProduct(t.rotation, quaternionExponential(turn)),
                          t.scale * vec4(difference.growth, 0.0));
}

uvec4 sampleOf(int instance, int number); // defined by the pass

// Mixes the blend samples of an instance for one track, see PoseInstruction.
JointTransform mixSamples(int instance, int track, RestParts rest, bool isWeights)
{
    const JointTransform nothing = JointTransform(vec4(0.0), vec4(0.0), vec4(0.0));
    const JointTransform everything = JointTransform(vec4(1.0), vec4(1.0), vec4(1.0));
    JointTransform total = fetchRest(track);
    JointTransform group = nothing;
    JointTransform reference = nothing;
    Difference difference = Difference(nothing, vec3(0.0), vec3(1.0));
    vec4 hemisphere = vec4(0.0);
    float sum = 0.0;
    JointTransform sums = nothing; // the weights of each number, with posed samples
    int count = sampleCount > 0 ? sampleCount : sampleStride; // a constant count is unrolled, which saves a third in llvmpipe
    for (int i = 0; i < count; ++i)
    {
        uvec4 blendSample = sampleOf(instance, i);
        float weight = uintBitsToFloat(blendSample.z);
        if (hasMasks) weight *= maskWeight(blendSample.w, track);
        if (hasLayers && (blendSample.w & POSE_SAMPLE_ABOVE) != 0u)
        {
            total = covered(total, group, sum, sums, isWeights);
            group = nothing;
            sum = 0.0;
            sums = nothing;
        }
        if (!(weight > 0.0)) continue;
        JointTransform t;
        JointTransform cover = everything;
        if (hasPosed && (blendSample.w & POSE_SAMPLE_POSED) != 0u) t = posedTrack(blendSample, track, cover);
        else t = sampleTrack(blendSample, track, rest, isWeights);
        if (hasAdditive && (blendSample.w & (POSE_SAMPLE_REFERENCE | POSE_SAMPLE_ADDITIVE)) != 0u)
        {
            if ((blendSample.w & POSE_SAMPLE_REFERENCE) != 0u) reference = t;
            else addDifference(difference, reference, hasPosed ? completed(t, reference, cover) : t, weight);
            continue;
        }
        if ((hasPosed ? sums.rotation.w : sum) == 0.0) hemisphere = t.rotation;
        if (!isWeights && dot(hemisphere, t.rotation) < 0.0) t.rotation = -t.rotation;
        addScaled(group, t, weight);
        if (hasPosed) addScaled(sums, cover, weight);
        else sum += weight;
    }
    total = covered(total, group, sum, sums, isWeights);
    if (!isWeights) total.rotation = normalize(total.rotation);
    return hasAdditive ? changed(total, difference, isWeights) : total;
}
