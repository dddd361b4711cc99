// SPDX-License-Identifier: MIT
// glTF's metallic-roughness surface (2.0, appendix B): GGX with height-correlated Smith visibility and Schlick's Fresnel
// term. The dielectric layer and the metal are evaluated apart and mixed by the metalness. Light that a rough surface
// reflects several times is added by Fdez-Agüera's formula ("A Multiple-Scattering Microfacet Model for Real-Time Image-based
// Lighting", 2019), so that a white surface under an even white surrounding is white. Included above: material.glsl.
#pragma import_defines(MATERIAL_SPECULAR, MATERIAL_CLEARCOAT, MATERIAL_SHEEN, MATERIAL_TRANSMISSION)

struct Surface
{
    vec3 baseColor;
    float metallic;
    float alpha;     // the square of the roughness
    vec3 normal;
    vec3 toEye;
    float cosEye;    // of the angle between the two
    vec3 dielectric; // reflection along the normal
    float grazing;   // the dielectric's reflection at grazing angles
    vec2 even;       // the reflection of an even white surrounding: even.x * F0 + even.y * F90
    vec3 again;      // the metal's reflection of a light after several bounces
    float diffuse;   // the share of light below the dielectric that is scattered, not transmitted
    vec3 coatNormal;
    float coat;      // the weight of the clear coat
    float coatAlpha;
    vec3 sheen;
    float sheenAlpha;
};

float largest(vec3 color)
{
    return max(color.r, max(color.g, color.b));
}

// The split-sum integral as fitted by Karis, "Physically Based Shading on Mobile", 2014.
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
    surface.even = evenReflection(surface.cosEye, clamped);
    float missing = 1.0 - (surface.even.x + surface.even.y);
    vec3 once = baseColor * surface.even.x + surface.even.y;
    vec3 mean = baseColor + (1.0 - baseColor) / 21.0;
    surface.again = surface.metallic * once * once * mean * (missing * missing) / (1.0 - missing * missing * mean);
#ifdef MATERIAL_SPECULAR
    vec4 specular = materialSpecularColor();
    surface.dielectric = min(specular.rgb, 1.0) * specular.a;
    surface.grazing = specular.a;
#else
    surface.dielectric = vec3(0.04);
    surface.grazing = 1.0;
#endif
    surface.diffuse = 1.0;
#ifdef MATERIAL_TRANSMISSION
    surface.diffuse -= materialTransmittance();
#endif
#ifdef MATERIAL_CLEARCOAT
    vec2 coat = materialCoat(surface.coatNormal);
    surface.coat = coat.x;
    surface.coatAlpha = max(coat.y * coat.y, 0.0025);
#endif
#ifdef MATERIAL_SHEEN
    vec4 sheen = materialSheenColor();
    surface.sheen = sheen.rgb;
    surface.sheenAlpha = max(sheen.a * sheen.a, 0.005);
#endif
    return surface;
}

// Distribution times visibility times pi.
float microfacets(float cosHalf, float cosLight, float cosEye, float alpha)
{
    float squared = alpha * alpha;
    float spread = cosHalf * cosHalf * (squared - 1.0) + 1.0;
    float masking = cosLight * sqrt(cosEye * cosEye * (1.0 - squared) + squared) +
                    cosEye * sqrt(cosLight * cosLight * (1.0 - squared) + squared);
    return 0.5 * squared / (spread * spread * masking);
}

float schlick(float cosine)
{
    float grazing = 1.0 - clamp(cosine, 0.0, 1.0);
    return grazing * grazing * grazing * grazing * grazing;
}

#ifdef MATERIAL_CLEARCOAT
// The share of light that passes the coat, there and back.
float belowCoat(Surface surface)
{
    return 1.0 - surface.coat * (0.04 + 0.96 * schlick(dot(surface.coatNormal, surface.toEye)));
}
#endif

#ifdef MATERIAL_SHEEN
// The share of an even surrounding that fibres reflect: a fit to the integral of the distribution below.
float evenSheen(Surface surface)
{
    float roughness = sqrt(surface.sheenAlpha);
    float inverse = 1.0 / (roughness + 0.1);
    float a = -1.9362 + 1.0678 * roughness + 0.4573 * roughness * roughness - 0.8469 * inverse;
    float b = -0.6014 + 0.5538 * roughness - 0.4670 * roughness * roughness - 0.1255 * inverse;
    return clamp(exp(a * surface.cosEye + b), 0.0, 1.0);
}

// Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", 2017, with Neubelt's visibility; times pi.
float fibres(Surface surface, float cosHalf, float cosLight)
{
    float inverse = 1.0 / surface.sheenAlpha;
    float sine = max(1.0 - cosHalf * cosHalf, 0.0078125);
    return (2.0 + inverse) * 0.125 * pow(sine, 0.5 * inverse) /
           (cosLight + surface.cosEye - cosLight * surface.cosEye);
}
#endif

// The reflection of a light of radiance 1 times pi along the normal: BRDF times pi times the cosine.
vec3 reflectedLight(Surface surface, vec3 toLight)
{
    float cosLight = dot(surface.normal, toLight);
    vec3 halfway = normalize(toLight + surface.toEye);
    float fresnel = schlick(dot(surface.toEye, halfway));
    vec3 reflected = vec3(0.0);
    if (cosLight > 0.0)
    {
        float cosHalf = clamp(dot(surface.normal, halfway), 0.0, 1.0);
        float specular = microfacets(cosHalf, cosLight, surface.cosEye, surface.alpha);
        vec3 dielectric = surface.dielectric + (surface.grazing - surface.dielectric) * fresnel;
        vec3 metal = surface.baseColor + (1.0 - surface.baseColor) * fresnel;
        float scattered = (1.0 - surface.metallic) * (1.0 - largest(dielectric)) * surface.diffuse;
        reflected = cosLight * (specular * mix(dielectric, metal, surface.metallic) + 3.14159 * surface.again +
                                scattered * surface.baseColor);
#ifdef MATERIAL_SHEEN
        reflected *= 1.0 - largest(surface.sheen) * evenSheen(surface);
        reflected += surface.sheen * (cosLight * fibres(surface, cosHalf, cosLight));
#endif
    }
#ifdef MATERIAL_CLEARCOAT
    reflected *= belowCoat(surface);
    float cosCoat = dot(surface.coatNormal, toLight);
    if (cosCoat > 0.0)
        reflected += surface.coat * (0.04 + 0.96 * fresnel) * cosCoat *
                     microfacets(clamp(dot(surface.coatNormal, halfway), 0.0, 1.0), cosCoat,
                                 clamp(dot(surface.coatNormal, surface.toEye), 0.001, 1.0), surface.coatAlpha);
#endif
    return reflected;
}

// The reflection of the surroundings. radiance: from around the mirrored direction, blurred by the roughness; coatRadiance:
// the same for the clear coat; irradiance: divided by pi, around the normal.
vec3 reflectedSurroundings(Surface surface, vec3 radiance, vec3 coatRadiance, vec3 irradiance)
{
    float missing = 1.0 - (surface.even.x + surface.even.y);
    vec3 dielectric = surface.dielectric * surface.even.x + surface.grazing * surface.even.y;
    vec3 dielectricMean = surface.dielectric + (surface.grazing - surface.dielectric) / 21.0;
    vec3 dielectricAgain = dielectric * dielectricMean * missing / (1.0 - missing * dielectricMean);
    vec3 metalMean = surface.baseColor + (1.0 - surface.baseColor) / 21.0;
    vec3 metal = surface.baseColor * surface.even.x + surface.even.y;
    vec3 metalAgain = metal * metalMean * missing / (1.0 - missing * metalMean);
    vec3 once = mix(dielectric, metal, surface.metallic);
    vec3 again = mix(dielectricAgain, metalAgain, surface.metallic);
    float scattered = (1.0 - surface.metallic) * (1.0 - largest(dielectric + dielectricAgain)) * surface.diffuse;
    vec3 reflected = once * radiance + (again + scattered * surface.baseColor) * irradiance;
#ifdef MATERIAL_SHEEN
    float fibre = evenSheen(surface);
    reflected = reflected * (1.0 - largest(surface.sheen) * fibre) + surface.sheen * fibre * irradiance;
#endif
#ifdef MATERIAL_CLEARCOAT
    vec2 even = evenReflection(clamp(dot(surface.coatNormal, surface.toEye), 0.001, 1.0), sqrt(surface.coatAlpha));
    reflected = reflected * belowCoat(surface) + surface.coat * (0.04 * even.x + even.y) * coatRadiance;
#endif
    return reflected;
}
