// SPDX-License-Identifier: MIT
// The studio's backdrop and its ground, which receives the shadow of the key light. The ground's space: the origin lies
// on the ground below the model, +Z is up, the unit is the model's radius. Included above: color.glsl.
#pragma import_defines(STUDIO_GROUND)

in vec3 rayStart;
in vec3 rayDirection;
in float height;

out vec4 fragmentColor;

#ifdef STUDIO_GROUND

uniform vec4 eyeDepth;       // of a point on the ground: above 0 in front of the eye
uniform mat4 mapFromGround;  // to the shadow map: [0, 1] each way
uniform vec3 mapSize;        // what the map covers, in the ground's units: width, height, depth
uniform float modelHeight;   // in the ground's units
uniform float shade;         // the share of the light that the shadow takes away
uniform sampler2D shadowMap; // depths from the key light

const int searches = 32;
const int taps = 36;
const float lightSize = 0.16; // the tangent of half the key light's angle

// Interleaved gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty", 2014), [0, 1).
float pixelNoise()
{
    return fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
}

// The direction of point `index` on Vogel's spiral; its radius is `share` of [0, 1], or the root of it: evenly dense.
vec2 spiral(int index, float turn)
{
    float angle = 2.39996323 * float(index) + turn;
    return vec2(cos(angle), sin(angle));
}
float share(int index, int count)
{
    return (float(index) + 0.5) / float(count);
}

// How far above the ground, towards the light, the nearest surface is at this offset from the place; 0: there is none.
float blockerDistance(vec3 place, vec2 offset, vec2 slope)
{
    offset /= mapSize.xy;
    float depth = texture(shadowMap, place.xy + offset).r;
    return depth < 1.0 ? max(place.z + dot(slope, offset) - depth, 0.0) * mapSize.z : 0.0;
}

// The share of the key light that arrives (x), and of the light from all around (y). Fernando, "Percentage-Closer Soft
// Shadows", 2005.
vec2 arrivingLight(vec3 place)
{
    vec2 margin = vec2(modelHeight * lightSize * 1.5) / mapSize.xy;
    bool isOnMap = all(greaterThan(place.xy, -margin)) && all(lessThan(place.xy, 1.0 + margin));
    vec2 slope = vec2(mapFromGround[0].z, mapFromGround[1].z) * inverse(mat2(mapFromGround)); // the ground's depth
    float turn = 6.2831853 * pixelNoise();
    float reach = modelHeight * lightSize * 1.4;
    float blockers = 0.0, distances = 0.0, contact = 0.0;
    int count = isOnMap ? searches : 0; // loops without passes cost nothing where branches do
    for (int i = 0; i < count; ++i) // denser in the middle, where thin parts near the ground matter
    {
        float distance = blockerDistance(place, reach * share(i, searches) * spiral(i, turn), slope);
        if (distance <= 0.0) continue;
        float weight = 1.0 / (distance + 0.04 * modelHeight);
        blockers += weight;
        distances += weight * distance;
        contact += exp(-7.0 * distance / modelHeight);
    }
    float radius = lightSize * distances / max(blockers, 1e-6);
    radius = clamp(radius, 1.5 * max(mapSize.x, mapSize.y) / float(textureSize(shadowMap, 0).x), reach);
    float shadowed = 0.0;
    count = blockers > 0.0 ? taps : 0;
    for (int i = 0; i < count; ++i)
        shadowed += blockerDistance(place, radius * sqrt(share(i, taps)) * spiral(i, turn), slope) > 0.0 ? 1.0 : 0.0;
    return 1.0 - vec2(shadowed / float(taps), min(1.8 * contact / float(searches), 1.0));
}

// The mean of this pixel and its neighbours in a block of 2 x 2 pixels, whose noise differs.
vec2 blockMean(vec2 value)
{
    vec2 side = 0.5 - mod(floor(gl_FragCoord.xy), 2.0); // 0.5: the next pixel is greater
    value += side.x * dFdx(value);
    return value + side.y * dFdy(value);
}

// Multiplies the backdrop's light.
float groundLight()
{
    float slant = min(rayDirection.z, -1e-6);
    vec3 ground = rayStart - rayStart.z / slant * rayDirection;
    bool isSeen = rayDirection.z < 0.0 && dot(eyeDepth, vec4(ground, 1.0)) > 0.0;
    vec4 place = mapFromGround * vec4(isSeen ? ground.xy : vec2(1e6), 0.0, 1.0);
    vec2 arriving = blockMean(arrivingLight(place.xyz));
    float pool = isSeen ? exp(-0.16 * dot(ground.xy, ground.xy)) : 0.0;
    return (1.0 + 0.12 * pool) * mix(1.0 - shade, 1.0, arriving.x) * mix(0.2, 1.0, arriving.y);
}

#endif

void main()
{
    vec3 color = mix(0.74, 0.93, height) * vec3(1.0, 1.0, 1.01);
#ifdef STUDIO_GROUND
    color = displayColor(linearColor(color) * groundLight());
#endif
    fragmentColor = vec4(color, 1.0);
}
