// SPDX-License-Identifier: MIT
// Lights a surface with OSG's lights, then applies the shadow maps of osgShadow's techniques and fog: with MATERIAL_PBR as
// glTF's metallic-roughness material in linear light, else the base colour in display space like the fixed pipeline. In a
// core profile without lights and surroundings: a headlight. DRAW_...: see ShaderKey in
// looks/shading/ShaderPermutations.h. To use it in another program, see lightShader() in looks/CharacterProgram.h.
// Included above: color.glsl, material.glsl, pbr.glsl, environment.glsl.
//
// GIVEN_MATERIAL: the values of the material come from a host's hook or from another program.
#pragma import_defines(MATERIAL_PBR, TONE_MAPPING)

uniform vec4 punctualLights[8]; // PunctualLight::coneAndRange()

uniform sampler2DShadow shadowMaps[7];  // of texture units 1 to 7
uniform vec2 osgShadow_ambientBias;     // osgShadow::ShadowMap: the share of light in shadow, and the remainder
uniform vec2 ambientBias;               // osgShadow::ParallelSplitShadowMap: the gain everywhere, and the loss in shadow

#ifdef GIVEN_MATERIAL
vec3 givenEmission;
vec3 givenSurface; // metallic, roughness, occlusion
vec3 givenNormal;
#define materialEmissive() givenEmission
#define materialSurface() givenSurface
#define materialNormal() givenNormal
#define fixedEmission givenEmission
#elif DRAW_FIXED_PIPELINE
#define fixedEmission gl_FrontMaterial.emission.rgb
#else
#define fixedEmission materialEmission
#endif

// The state of the fixed pipeline: of GL, or in a core profile by uniforms, see ViewLights.
#if DRAW_FIXED_PIPELINE
#define lightSource(index) gl_LightSource[index]
#define lightModelAmbient gl_LightModel.ambient
#define shineColor gl_FrontMaterial.specular
#define shininess gl_FrontMaterial.shininess
#define fogColor gl_Fog.color
#define fogDensity gl_Fog.density
#define fogEnd gl_Fog.end
#define fogScale gl_Fog.scale
#else
struct LightSource
{
    vec4 ambient;
    vec4 diffuse;
    vec4 specular;
    vec4 position; // in eye space, as the direction
    vec3 spotDirection;
    float spotExponent;
    float spotCutoff; // degrees; 180: shines everywhere
    float spotCosCutoff;
    float constantAttenuation;
    float linearAttenuation;
    float quadraticAttenuation;
};
// osg::LightModel's ambient colour; the specular colour and the shininess; the colour of the fog; its density, start, end,
// 1 / (end - start); then of each light: ambient, diffuse, specular and the cosine of the cutoff, position, spot direction
// and exponent, cutoff and attenuations.
uniform vec4 coreState[4 + 6 * 8];

LightSource coreLight(int index)
{
    int first = 4 + 6 * index;
    vec4 spot = coreState[first + 4], last = coreState[first + 5];
    return LightSource(coreState[first], coreState[first + 1], coreState[first + 2], coreState[first + 3], spot.xyz, spot.w,
                       last.x, coreState[first + 2].a, last.y, last.z, last.w);
}
#undef DRAW_SHADOW_MAPS
#define DRAW_SHADOW_MAPS 0 // osgShadow's have generated texture coordinates
#define lightSource(index) coreLight(index)
#define lightModelAmbient coreState[0]
#define shineColor coreState[1]
#define shininess coreState[1].a
#define fogColor coreState[2]
#define fogDensity coreState[3].x
#define fogEnd coreState[3].z
#define fogScale coreState[3].w
#endif

#ifdef MATERIAL_PBR
// Emission, reflected lights and reflected surroundings.
vec3 surfaceColor(Surface surface, vec3 direct, vec3 ambient, float occlusion)
{
    vec3 emission = materialEmissive();
#ifdef MATERIAL_CLEARCOAT
    emission *= belowCoat(surface);
#endif
    return emission + direct + surroundingLight(surface, ambient, occlusion);
}
#endif

#if DRAW_FIXED_PIPELINE || DRAW_LIGHTS || defined(ENVIRONMENT)

// The direction to the light, and its attenuation (OpenGL 2.1, section 2.14.1).
vec3 directionTo(int index, out float strength)
{
    vec4 position = lightSource(index).position;
    strength = 1.0;
    if ((DRAW_POINT_LIGHTS & (1 << index)) == 0) return normalize(position.xyz);
    vec3 way = position.xyz / position.w - viewPosition;
    float range = length(way);
    vec3 toLight = way / range;
    strength = 1.0 / (lightSource(index).constantAttenuation + lightSource(index).linearAttenuation * range +
                      lightSource(index).quadraticAttenuation * range * range);
    float along = dot(-toLight, normalize(lightSource(index).spotDirection));
#ifdef MATERIAL_PBR
    if ((DRAW_PUNCTUAL_LIGHTS & (1 << index)) != 0)
    {
        vec4 light = punctualLights[index];
        float cone = clamp(along * light.x + light.y, 0.0, 1.0);
        float share = range * range * light.z;
        strength *= cone * cone * clamp(1.0 - share * share, 0.0, 1.0);
        return toLight;
    }
#endif
    if (lightSource(index).spotCutoff < 180.0) // the cosine is 0 in Mesa for 180 degrees
        strength *= along < lightSource(index).spotCosCutoff
                        ? 0.0
                        : pow(max(along, 0.0001), lightSource(index).spotExponent);
    return toLight;
}

#ifdef MATERIAL_PBR

struct Light
{
    vec3 ambient; // the radiance of an even surrounding
    vec3 direct;  // reflected
};

void addLight(int index, Surface surface, inout Light sum)
{
    float strength;
    vec3 toLight = directionTo(index, strength);
    sum.ambient += strength * lightSource(index).ambient.rgb;
    sum.direct += strength * lightSource(index).diffuse.rgb * reflectedLight(surface, toLight);
}

#else

struct Light
{
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
};

void addLight(int index, vec3 normal, inout Light sum)
{
    float strength;
    vec3 toLight = directionTo(index, strength);
    float diffuse = max(dot(normal, toLight), 0.0);
    sum.ambient += strength * lightSource(index).ambient.rgb;
    sum.diffuse += strength * diffuse * lightSource(index).diffuse.rgb;
#if DRAW_SPECULAR
    vec3 halfway = normalize(toLight - normalize(viewPosition));
    float specular = diffuse > 0.0 ? pow(max(dot(normal, halfway), 0.0), max(shininess, 1.0)) : 0.0;
    sum.specular += strength * specular * lightSource(index).specular.rgb;
#endif
}

#endif

#if DRAW_SHADOW_MAPS

// The technique generates the unit's texture coordinates from the view position.
float unshadowed(sampler2DShadow map, int unit)
{
    vec4 position = vec4(viewPosition, 1.0);
    vec4 place = vec4(dot(gl_EyePlaneS[unit], position), dot(gl_EyePlaneT[unit], position),
                      dot(gl_EyePlaneR[unit], position), dot(gl_EyePlaneQ[unit], position));
#if DRAW_SHADOW_SPLITS
    place.z -= 0.001954 * place.w; // the bias of its own shader against self-shadowing: 1/512
#endif
    return textureProj(map, place);
}

float unshadowedByAll()
{
    float share = 1.0;
#if DRAW_SHADOW_MAPS & 2
    share *= unshadowed(shadowMaps[0], 1);
#endif
#if DRAW_SHADOW_MAPS & 4
    share *= unshadowed(shadowMaps[1], 2);
#endif
#if DRAW_SHADOW_MAPS & 8
    share *= unshadowed(shadowMaps[2], 3);
#endif
#if DRAW_SHADOW_MAPS & 16
    share *= unshadowed(shadowMaps[3], 4);
#endif
#if DRAW_SHADOW_MAPS & 32
    share *= unshadowed(shadowMaps[4], 5);
#endif
#if DRAW_SHADOW_MAPS & 64
    share *= unshadowed(shadowMaps[5], 6);
#endif
#if DRAW_SHADOW_MAPS & 128
    share *= unshadowed(shadowMaps[6], 7);
#endif
    return share;
}

// The same darkening as in the techniques' own shaders.
vec3 shadowedColor(vec3 color, vec3 colorWithoutLights)
{
    float share = unshadowedByAll();
#if DRAW_SHADOW_BIAS
    return color * (osgShadow_ambientBias.x + share * osgShadow_ambientBias.y);
#elif DRAW_SHADOW_SPLITS
    return color * (1.0 + ambientBias.x) * (1.0 - ambientBias.y * (1.0 - share));
#else
    return mix(colorWithoutLights, color, share);
#endif
}

#endif

vec3 litColor(vec3 base)
{
#ifdef MATERIAL_PBR
    vec3 factors = materialSurface();
    Surface lit = makeSurface(base, factors.x, factors.y, materialNormal());
    Light sum = Light(lightModelAmbient.rgb, vec3(0.0));
#else
    vec3 lit = materialNormal();
    Light sum = Light(vec3(0.0), vec3(0.0), vec3(0.0));
#endif
#if DRAW_LIGHTS & 1
    addLight(0, lit, sum);
#endif
#if DRAW_LIGHTS & 2
    addLight(1, lit, sum);
#endif
#if DRAW_LIGHTS & 4
    addLight(2, lit, sum);
#endif
#if DRAW_LIGHTS & 8
    addLight(3, lit, sum);
#endif
#if DRAW_LIGHTS & 16
    addLight(4, lit, sum);
#endif
#if DRAW_LIGHTS & 32
    addLight(5, lit, sum);
#endif
#if DRAW_LIGHTS & 64
    addLight(6, lit, sum);
#endif
#if DRAW_LIGHTS & 128
    addLight(7, lit, sum);
#endif
#ifdef MATERIAL_PBR
#if DRAW_SHADOW_MAPS
    sum.direct *= unshadowedByAll();
#endif
    return surfaceColor(lit, sum.direct, sum.ambient, factors.z);
#else
    vec3 withoutLights = fixedEmission + base * lightModelAmbient.rgb;
    vec3 color = withoutLights + base * (sum.ambient + sum.diffuse) + shineColor.rgb * sum.specular;
#if DRAW_SHADOW_MAPS
    color = shadowedColor(color, withoutLights);
#endif
    return color;
#endif
}

#else

vec3 litColor(vec3 base)
{
#ifdef MATERIAL_PBR
    vec3 factors = materialSurface();
    Surface surface = makeSurface(base, factors.x, factors.y, materialNormal());
    return surfaceColor(surface, 0.8 * reflectedLight(surface, surface.toEye), vec3(0.2), factors.z);
#else
    return fixedEmission + base * (0.2 + 0.8 * max(dot(materialNormal(), normalize(-viewPosition)), 0.0));
#endif
}

#endif

vec3 foggedColor(vec3 color)
{
    float depth = abs(viewPosition.z);
#if DRAW_FOG == 1
    float clear = (fogEnd - depth) * fogScale;
#elif DRAW_FOG == 2
    float clear = exp(-fogDensity * depth);
#else
    float clear = exp(-fogDensity * fogDensity * depth * depth);
#endif
#if defined(MATERIAL_PBR) && !DRAW_ENCODED
    return mix(linearColor(fogColor.rgb), color, clamp(clear, 0.0, 1.0));
#else
    return mix(fogColor.rgb, color, clamp(clear, 0.0, 1.0));
#endif
}

// From linear light to the framebuffer's.
vec3 shownColor(vec3 color)
{
#ifdef MATERIAL_PBR
#ifdef TONE_MAPPING
    color = toneMappedColor(color);
#endif
#if DRAW_ENCODED
    color = displayColor(color);
#endif
#endif
    return color;
}
