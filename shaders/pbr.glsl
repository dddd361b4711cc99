// SPDX-License-Identifier: MIT
// glTF's metallic-roughness surface (2.0, appendix B): GGX with height-correlated Smith visibility and Schlick's Fresnel
// term. The dielectric layer and the metal are evaluated apart and mixed by the metalness. Light that a rough surface
// reflects several times is added by Fdez-Agüera's formula ("A Multiple-Scattering Microfacet Model for Real-Time Image-based
// Lighting", 2019), so that a white surface under an even white surrounding is white.

#define DIELECTRIC_F0 0.04

struct Surface
{
    vec3 baseColor;
    float metallic;
    float alpha;     // the square of the roughness
    vec3 normal;
    vec3 toEye;
    float cosEye;    // of the angle between the two
    vec2 reflection; // of an even white surrounding: reflection.x * F0 + reflection.y
    vec3 again;      // a light's reflection by the metal after several bounces
};

// Karis, "Physically Based Shading on Mobile", 2014: the split-sum integral.
vec2 evenReflection(float cosEye, float roughness)
{
    const vec4 c0 = vec4(-1.0, -0.0275, -0.572, 0.022);
    const vec4 c1 = vec4(1.0, 0.0425, 1.04, -0.04);
    vec4 r = roughness * c0 + c1;
    float a004 = min(r.x * r.x, exp2(-9.28 * cosEye)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a004 + r.zw;
}

Surface makeSurface(vec3 baseColor, float metallic, float roughness, vec3 normal)
{
    Surface surface;
    surface.baseColor = baseColor;
    surface.metallic = clamp(metallic, 0.0, 1.0);
    float clamped = clamp(roughness, 0.05, 1.0); // a smaller highlight than a pixel's would flicker
    surface.alpha = clamped * clamped;
    surface.normal = normal;
    surface.toEye = normalize(-viewPosition);
    surface.cosEye = clamp(dot(normal, surface.toEye), 0.001, 1.0);
    surface.reflection = evenReflection(surface.cosEye, clamped);
    float missing = 1.0 - (surface.reflection.x + surface.reflection.y);
    vec3 once = baseColor * surface.reflection.x + surface.reflection.y;
    vec3 mean = baseColor + (1.0 - baseColor) / 21.0;
    surface.again = surface.metallic * once * once * mean * (missing * missing) / (1.0 - missing * missing * mean);
    return surface;
}

// The reflection of a light of radiance 1 times pi along the normal: BRDF times pi times the cosine.
vec3 reflectedLight(Surface surface, vec3 toLight)
{
    float cosLight = dot(surface.normal, toLight);
    if (cosLight <= 0.0) return vec3(0.0);
    vec3 halfway = normalize(toLight + surface.toEye);
    float cosHalf = clamp(dot(surface.normal, halfway), 0.0, 1.0);
    float squared = surface.alpha * surface.alpha;
    float spread = cosHalf * cosHalf * (squared - 1.0) + 1.0;
    float masking = cosLight * sqrt(surface.cosEye * surface.cosEye * (1.0 - squared) + squared) +
                    surface.cosEye * sqrt(cosLight * cosLight * (1.0 - squared) + squared);
    float specular = 0.5 * squared / (spread * spread * masking); // pi times distribution times visibility

    float grazing = 1.0 - clamp(dot(surface.toEye, halfway), 0.0, 1.0);
    float fresnel = grazing * grazing * grazing * grazing * grazing;
    float dielectric = DIELECTRIC_F0 + (1.0 - DIELECTRIC_F0) * fresnel;
    vec3 metal = surface.baseColor + (1.0 - surface.baseColor) * fresnel;
    vec3 layers = mix(vec3(dielectric), metal, surface.metallic);
    return cosLight * (specular * layers + 3.14159 * surface.again + (1.0 - surface.metallic) * (1.0 - dielectric) * surface.baseColor);
}

// The reflection of the surroundings. radiance: from around the mirrored direction, blurred by the roughness;
// irradiance: divided by pi, around the normal.
vec3 reflectedSurroundings(Surface surface, vec3 radiance, vec3 irradiance)
{
    float missing = 1.0 - (surface.reflection.x + surface.reflection.y);
    const float dielectricMean = DIELECTRIC_F0 + (1.0 - DIELECTRIC_F0) / 21.0;
    float dielectric = DIELECTRIC_F0 * surface.reflection.x + surface.reflection.y;
    float dielectricAgain = dielectric * dielectricMean * missing / (1.0 - missing * dielectricMean);
    vec3 metalMean = surface.baseColor + (1.0 - surface.baseColor) / 21.0;
    vec3 metal = surface.baseColor * surface.reflection.x + surface.reflection.y;
    vec3 metalAgain = metal * metalMean * missing / (1.0 - missing * metalMean);
    vec3 once = mix(vec3(dielectric), metal, surface.metallic);
    vec3 again = mix(vec3(dielectricAgain), metalAgain, surface.metallic);
    vec3 diffuse = (1.0 - surface.metallic) * (1.0 - dielectric - dielectricAgain) * surface.baseColor;
    return once * radiance + (again + diffuse) * irradiance;
}
