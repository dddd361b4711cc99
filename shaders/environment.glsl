// SPDX-License-Identifier: MIT
// The surroundings that light a surface, see looks/Environment.h. ENVIRONMENT: 1: the analytic studio; 2: a prefiltered cube
// map with spherical harmonics; none: the ambient light of OSG's lights, evenly from all directions.
#pragma import_defines(ENVIRONMENT)

#ifdef ENVIRONMENT
uniform mat3 environmentFromEye; // directions, to glTF's axes
uniform float environmentIntensity;

#if ENVIRONMENT == 1

// A gradient from below to above and three lobes of light, exp(sharpness * (cos - 1)).
#define STUDIO_KEY vec3(0.388922, 0.713024, 0.583383)
#define STUDIO_FILL vec3(-0.853579, 0.298753, 0.426790)
#define STUDIO_RIM vec3(-0.249136, 0.498273, -0.830455)

// A polynomial of degree 4 in the cosine, fitted to the numeric integral.
float studioIrradiance(vec3 fit, float linear, float cosine)
{
    float square = cosine * cosine;
    return fit.x + linear * cosine + square * (fit.y + fit.z * square);
}

vec3 environmentIrradiance(vec3 normal)
{
    return mix(vec3(0.22, 0.21, 0.20), vec3(0.62, 0.66, 0.72), 0.5 + 0.4 * normal.y) +
           vec3(9.0, 8.6, 8.0) * studioIrradiance(vec3(0.0039166, 0.0350570, -0.0154537), 0.0243750, dot(normal, STUDIO_KEY)) +
           vec3(1.0, 1.15, 1.4) * studioIrradiance(vec3(0.0128664, 0.0710357, -0.0264009), 0.0585938, dot(normal, STUDIO_FILL)) +
           vec3(7.0) * studioIrradiance(vec3(0.0024079, 0.0245205, -0.0111962), 0.0163889, dot(normal, STUDIO_RIM));
}

// The surface's lobe and the light's lobe are spherical Gaussians; so is their convolution (Wang and others, "All-Frequency
// Rendering of Dynamic, Spatially-Varying Reflectance", 2009).
float studioLobe(vec3 direction, vec3 towards, float sharpness, float surfaceSharpness)
{
    float wide = sharpness * surfaceSharpness / (sharpness + surfaceSharpness);
    return wide / (sharpness * (1.0 - exp(-2.0 * wide))) * exp(wide * (dot(direction, towards) - 1.0));
}

vec3 environmentRadiance(vec3 direction, float alpha, float cosEye)
{
    float sharpness = 0.5 / (alpha * alpha * max(cosEye, 0.1));
    float height = 0.5 + 0.5 * direction.y * (1.0 - alpha * 0.4);
    vec3 gradient = mix(vec3(0.22, 0.21, 0.20), vec3(0.62, 0.66, 0.72), height * height * (3.0 - 2.0 * height));
    return gradient + vec3(9.0, 8.6, 8.0) * studioLobe(direction, STUDIO_KEY, 40.0, sharpness) +
           vec3(1.0, 1.15, 1.4) * studioLobe(direction, STUDIO_FILL, 16.0, sharpness) +
           vec3(7.0) * studioLobe(direction, STUDIO_RIM, 60.0, sharpness);
}

#else

uniform samplerCube environmentMap;      // one level a roughness, from 0 to 1
uniform float environmentLevels;         // the number of levels, less one
uniform vec3 environmentHarmonics[9];    // of the irradiance divided by pi

// Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001.
vec3 environmentIrradiance(vec3 n)
{
    vec3 sum = environmentHarmonics[0] + environmentHarmonics[1] * n.y + environmentHarmonics[2] * n.z +
               environmentHarmonics[3] * n.x + environmentHarmonics[4] * (n.x * n.y) +
               environmentHarmonics[5] * (n.y * n.z) + environmentHarmonics[6] * (3.0 * n.z * n.z - 1.0) +
               environmentHarmonics[7] * (n.x * n.z) + environmentHarmonics[8] * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0));
}

vec3 environmentRadiance(vec3 direction, float alpha, float cosEye)
{
    return textureLod(environmentMap, direction, sqrt(alpha) * environmentLevels).rgb;
}

#endif
#endif

#ifdef ENVIRONMENT
// From around the mirrored direction of a normal.
vec3 mirroredRadiance(Surface surface, vec3 normal, float alpha)
{
    vec3 mirrored = reflect(-surface.toEye, normal);
    mirrored = normalize(mix(mirrored, normal, alpha * alpha)); // rough lobes lean towards the normal
    float cosEye = clamp(dot(normal, surface.toEye), 0.0, 1.0);
    return environmentIntensity * environmentRadiance(environmentFromEye * mirrored, alpha, cosEye);
}
#endif

// ambient: the radiance of an even surrounding, used without an environment. occlusion: 1: none.
vec3 surroundingLight(Surface surface, vec3 ambient, float occlusion)
{
    vec3 radiance = ambient;
    vec3 coatRadiance = ambient;
    vec3 irradiance = ambient;
#ifdef ENVIRONMENT
    radiance = mirroredRadiance(surface, surface.normal, surface.alpha);
    irradiance = environmentIntensity * environmentIrradiance(environmentFromEye * surface.normal);
#ifdef MATERIAL_CLEARCOAT
    coatRadiance = mirroredRadiance(surface, surface.coatNormal, surface.coatAlpha);
#endif
#endif
#ifdef MATERIAL_OCCLUSION_MAP
    // Lagarde and de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014.
    float roughness = sqrt(surface.alpha);
    radiance *= clamp(pow(surface.cosEye + occlusion, exp2(-16.0 * roughness - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
    coatRadiance *= occlusion;
    irradiance *= occlusion;
#endif
    return reflectedSurroundings(surface, radiance, coatRadiance, irradiance);
}
