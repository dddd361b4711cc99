// SPDX-License-Identifier: MIT
// One level of one face of a prefiltered cube map, see looks/environment/PrefilteredMap.h: the radiance that GGX reflects of the
// surroundings, with the eye in the direction of the normal (Karis, "Real Shading in Unreal Engine 4", 2013). Each sample
// reads the mipmap whose pixels are as large as the sample's share of all directions (Krivanek and Colbert, "Real-time
// Shading with Filtered Importance Sampling", 2008).

#define SAMPLES 256u

in vec2 place;

uniform samplerCube radiance; // with mipmaps
uniform float side;           // pixels across its level 0
uniform float size;           // pixels across the level that is drawn
uniform float alpha;          // the square of the roughness
uniform int face;             // 0 to 5: +X, -X, +Y, -Y, +Z, -Z

out vec4 color;

// OpenGL 4.6, table 8.19.
vec3 directionOf(vec2 st)
{
    if (face == 0) return vec3(1.0, -st.y, -st.x);
    if (face == 1) return vec3(-1.0, -st.y, st.x);
    if (face == 2) return vec3(st.x, 1.0, st.y);
    if (face == 3) return vec3(st.x, -1.0, -st.y);
    if (face == 4) return vec3(st.x, -st.y, 1.0);
    return vec3(-st.x, -st.y, -1.0);
}

// Hammersley's points.
vec2 sampleAt(uint index)
{
    uint bits = (index << 16u) | (index >> 16u);
    bits = ((bits & 0x55555555u) << 1u) | ((bits & 0xAAAAAAAAu) >> 1u);
    bits = ((bits & 0x33333333u) << 2u) | ((bits & 0xCCCCCCCCu) >> 2u);
    bits = ((bits & 0x0F0F0F0Fu) << 4u) | ((bits & 0xF0F0F0F0u) >> 4u);
    bits = ((bits & 0x00FF00FFu) << 8u) | ((bits & 0xFF00FF00u) >> 8u);
    return vec2((float(index) + 0.5) / float(SAMPLES), float(bits) * 2.3283064365386963e-10);
}

void main()
{
    vec3 normal = normalize(directionOf(place));
    if (alpha == 0.0)
    {
        color = vec4(textureLod(radiance, normal, log2(side / size)).rgb, 1.0);
        return;
    }
    vec3 tangent = normalize(cross(abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), normal));
    vec3 bitangent = cross(normal, tangent);
    float squared = alpha * alpha;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (uint i = 0u; i < SAMPLES; ++i)
    {
        vec2 random = sampleAt(i);
        float cosHalf2 = (1.0 - random.x) / (1.0 + (squared - 1.0) * random.x);
        float cosHalf = sqrt(cosHalf2);
        float sinHalf = sqrt(1.0 - cosHalf2);
        float turn = 6.2831853 * random.y;
        vec3 towards = vec3(2.0 * cosHalf * sinHalf * vec2(cos(turn), sin(turn)), 2.0 * cosHalf2 - 1.0);
        if (towards.z <= 0.0) continue;
        float spread = cosHalf2 * (squared - 1.0) + 1.0;
        float density = squared / (12.5663706 * spread * spread); // of directions: the distribution over four
        // The solid angles of the sample and of a pixel; one more level hides the samples from each other.
        float level = 0.5 * log2(6.0 * side * side / (12.5663706 * float(SAMPLES) * density)) + 1.0;
        vec3 direction = towards.x * tangent + towards.y * bitangent + towards.z * normal;
        sum += textureLod(radiance, direction, max(level, 0.0)).rgb * towards.z;
        weights += towards.z;
    }
    color = vec4(sum / weights, 1.0);
}
