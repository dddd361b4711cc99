// SPDX-License-Identifier: MIT
// Lights the base colour per fragment with OSG's lights like the fixed pipeline, then applies the shadow maps of
// osgShadow's techniques and fog. In a core profile, which has no lights: a headlight. DRAW_...: see ShaderKey in
// nodes/shading/ShaderPermutations.h. This shader reads inputs only if it needs them, because the linker removes unread
// outputs of the vertex shader. POSE_COLORED: the mesh or its morph targets have colours; POSE_TINTED: the drawn
// instances have tints.
#pragma import_defines(POSE_COLORED, POSE_TINTED)

uniform sampler2D baseColorTexture;
uniform float alphaCutoff;

uniform vec4 materialDiffuse; // gl_FrontMaterial.diffuse keeps other meshes' colours under colour material modes
#ifndef GL_ARB_compatibility
uniform vec4 materialEmission;
#endif

uniform sampler2DShadow shadowMaps[7];  // of texture units 1 to 7
uniform vec2 osgShadow_ambientBias;     // osgShadow::ShadowMap: the share of light in shadow, and the remainder
uniform vec2 ambientBias;               // osgShadow::ParallelSplitShadowMap: the gain everywhere, and the loss in shadow

in vec3 viewPosition;
in vec3 viewNormal;
in vec4 vertexColor;
in vec2 textureCoordinate;

out vec4 fragmentColor;

vec4 baseColor()
{
    vec4 color = materialDiffuse;
#if defined(POSE_COLORED) || defined(POSE_TINTED)
    color *= vertexColor;
#endif
#if DRAW_TEXTURE
    color *= texture(baseColorTexture, textureCoordinate);
#endif
    if (color.a < alphaCutoff) discard;
    return color;
}

vec3 facingNormal()
{
#if DRAW_FLAT_NORMALS
    return normalize(cross(dFdx(viewPosition), dFdy(viewPosition)));
#else
    return normalize(gl_FrontFacing ? viewNormal : -viewNormal);
#endif
}

#ifdef GL_ARB_compatibility

struct Light
{
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
};

// OpenGL 2.1, section 2.14.1.
void addLight(int index, vec3 normal, inout Light sum)
{
    vec4 position = gl_LightSource[index].position;
    vec3 toLight = normalize(position.xyz);
    float strength = 1.0;
    if ((DRAW_POINT_LIGHTS & (1 << index)) != 0)
    {
        vec3 way = position.xyz / position.w - viewPosition;
        float range = length(way);
        toLight = way / range;
        strength = 1.0 / (gl_LightSource[index].constantAttenuation + gl_LightSource[index].linearAttenuation * range +
                          gl_LightSource[index].quadraticAttenuation * range * range);
        float along = dot(-toLight, normalize(gl_LightSource[index].spotDirection));
        if (gl_LightSource[index].spotCosCutoff > -1.0)
            strength *= along < gl_LightSource[index].spotCosCutoff
                            ? 0.0
                            : pow(max(along, 0.0001), gl_LightSource[index].spotExponent);
    }
    float diffuse = max(dot(normal, toLight), 0.0);
    sum.ambient += strength * gl_LightSource[index].ambient.rgb;
    sum.diffuse += strength * diffuse * gl_LightSource[index].diffuse.rgb;
#if DRAW_SPECULAR
    vec3 halfway = normalize(toLight - normalize(viewPosition));
    float specular = diffuse > 0.0 ? pow(max(dot(normal, halfway), 0.0), max(gl_FrontMaterial.shininess, 1.0)) : 0.0;
    sum.specular += strength * specular * gl_LightSource[index].specular.rgb;
#endif
}

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

vec3 litColor(vec3 base)
{
    Light sum = Light(vec3(0.0), vec3(0.0), vec3(0.0));
    vec3 normal = facingNormal();
#if DRAW_LIGHTS & 1
    addLight(0, normal, sum);
#endif
#if DRAW_LIGHTS & 2
    addLight(1, normal, sum);
#endif
#if DRAW_LIGHTS & 4
    addLight(2, normal, sum);
#endif
#if DRAW_LIGHTS & 8
    addLight(3, normal, sum);
#endif
#if DRAW_LIGHTS & 16
    addLight(4, normal, sum);
#endif
#if DRAW_LIGHTS & 32
    addLight(5, normal, sum);
#endif
#if DRAW_LIGHTS & 64
    addLight(6, normal, sum);
#endif
#if DRAW_LIGHTS & 128
    addLight(7, normal, sum);
#endif
    vec3 withoutLights = gl_FrontMaterial.emission.rgb + base * gl_LightModel.ambient.rgb;
    vec3 color = withoutLights + base * (sum.ambient + sum.diffuse) + gl_FrontMaterial.specular.rgb * sum.specular;
#if DRAW_SHADOW_MAPS
    color = shadowedColor(color, withoutLights);
#endif
    return color;
}

vec3 foggedColor(vec3 color)
{
    float depth = abs(viewPosition.z);
#if DRAW_FOG == 1
    float clear = (gl_Fog.end - depth) * gl_Fog.scale;
#elif DRAW_FOG == 2
    float clear = exp(-gl_Fog.density * depth);
#else
    float clear = exp(-gl_Fog.density * gl_Fog.density * depth * depth);
#endif
    return mix(gl_Fog.color.rgb, color, clamp(clear, 0.0, 1.0));
}

#else

vec3 litColor(vec3 base)
{
    return materialEmission.rgb + base * (0.2 + 0.8 * max(dot(facingNormal(), normalize(-viewPosition)), 0.0));
}

#endif

void main()
{
#if DRAW_COLOR
    vec4 color = baseColor();
#if DRAW_LIGHTING
    color.rgb = litColor(color.rgb);
#endif
#if DRAW_FOG && defined(GL_ARB_compatibility)
    color.rgb = foggedColor(color.rgb);
#endif
    fragmentColor = color;
#elif DRAW_ALPHA
    fragmentColor = baseColor();
#else
    fragmentColor = vec4(1.0);
#endif
}
