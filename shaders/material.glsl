// SPDX-License-Identifier: MIT
// The values of glTF's material (2.0, section 3.9) at a fragment. To use them in another program, link this shader, see
// materialShader() in nodes/CharacterProgram.h, declare
//     void osgGpuAnimationMaterial(out vec4 baseColor, out vec3 emission, out vec3 metallicRoughnessOcclusion,
//                                  out vec3 normal);
// and call it. Colours are linear with MATERIAL_PBR, else as displayed; the normal is in eye space, normalized, and points
// to the viewer. The vertex shader writes the inputs, as character.vert does.
//
// OSG's shader defines remove the maps that a material does not have. The value of MATERIAL_..._MAP is the number of its
// texture coordinates: 0 to 2. This shader reads inputs only if it needs them, because the linker removes unread outputs of
// the vertex shader. POSE_COLORED: the mesh or its morph targets have colours; POSE_TINTED: the drawn instances have tints.
#pragma import_defines(POSE_COLORED, POSE_TINTED, MATERIAL_PBR, MATERIAL_TANGENTS, MATERIAL_METALLIC_ROUGHNESS_MAP)
#pragma import_defines(MATERIAL_NORMAL_MAP, MATERIAL_OCCLUSION_MAP, MATERIAL_EMISSIVE_MAP, MATERIAL_EMISSIVE_STRENGTH)
#pragma import_defines(MATERIAL_MORE_COORDINATES)

#ifndef DRAW_TEXTURE
#define DRAW_TEXTURE 1
#define DRAW_FLAT_NORMALS 0
#endif

uniform sampler2D baseColorTexture; // sRGB with MATERIAL_PBR
uniform sampler2D metallicRoughnessTexture;
uniform sampler2D normalTexture;
uniform sampler2D occlusionTexture;
uniform sampler2D emissiveTexture; // sRGB

uniform vec4 materialDiffuse;  // osg::Material's; gl_FrontMaterial keeps other meshes' colours under colour material modes
uniform vec3 materialEmission; // osg::Material's
uniform vec4 materialFactors;  // metallic, roughness, scale of the normal map, strength of the occlusion map
uniform float emissiveStrength; // KHR_materials_emissive_strength
uniform float alphaCutoff;

in vec3 viewPosition;
in vec3 viewNormal;
in vec4 vertexColor;
in vec2 textureCoordinate;
#ifdef MATERIAL_MORE_COORDINATES
in vec4 moreCoordinates; // numbers 1 and 2
#endif
#ifdef MATERIAL_TANGENTS
in vec4 viewTangent; // w: the bitangent is w * cross(normal, tangent)
#endif

vec2 coordinates(int number)
{
#ifdef MATERIAL_MORE_COORDINATES
    if (number == 1) return moreCoordinates.xy;
    if (number == 2) return moreCoordinates.zw;
#endif
    return textureCoordinate;
}

// Discards fragments below alphaCutoff.
vec4 materialBaseColor()
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

#ifdef MATERIAL_NORMAL_MAP
// The map's normal in eye space. Without tangents, the derivatives of position and coordinates replace them (Mikkelsen,
// "Bump Mapping Unparametrized Surfaces on the GPU", 2010). The second coordinate grows with the map's +Y.
vec3 mappedNormal(vec3 normal)
{
    vec2 place = coordinates(MATERIAL_NORMAL_MAP);
    vec3 map = texture(normalTexture, place).xyz * 2.0 - 1.0;
    map.xy *= materialFactors.z;
    float facing = gl_FrontFacing ? 1.0 : -1.0;
#ifdef MATERIAL_TANGENTS
    vec3 tangent = viewTangent.xyz;
    vec3 bitangent = viewTangent.w * cross(normal, tangent);
    if (dot(tangent, tangent) < 1e-12) return facing * normal;
    map.xy *= facing;
#else
    vec3 alongX = cross(dFdy(viewPosition), normal);
    vec3 alongY = cross(normal, dFdx(viewPosition));
    vec2 placeX = dFdx(place);
    vec2 placeY = dFdy(place);
    vec3 tangent = alongX * placeX.x + alongY * placeY.x;
    vec3 bitangent = alongX * placeX.y + alongY * placeY.y;
    float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    if (longest <= 0.0) return facing * normal;
    map.xy *= inversesqrt(longest);
#endif
    return normalize(map.x * tangent + map.y * bitangent + map.z * facing * normal);
}
#endif

vec3 materialNormal()
{
#if DRAW_FLAT_NORMALS
    vec3 normal = normalize(cross(dFdx(viewPosition), dFdy(viewPosition)));
    if (!gl_FrontFacing) normal = -normal;
#else
    vec3 normal = normalize(viewNormal);
#endif
#ifdef MATERIAL_NORMAL_MAP
    return mappedNormal(normal);
#else
    return gl_FrontFacing ? normal : -normal;
#endif
}

vec3 materialEmissive()
{
    vec3 emission = materialEmission;
#ifdef MATERIAL_EMISSIVE_MAP
    emission *= texture(emissiveTexture, coordinates(MATERIAL_EMISSIVE_MAP)).rgb;
#endif
#ifdef MATERIAL_EMISSIVE_STRENGTH
    emission *= emissiveStrength;
#endif
    return emission;
}

// Metallic, roughness, occlusion (1: none).
vec3 materialSurface()
{
    vec3 surface = vec3(materialFactors.xy, 1.0);
#ifdef MATERIAL_METALLIC_ROUGHNESS_MAP
    surface.xy *= texture(metallicRoughnessTexture, coordinates(MATERIAL_METALLIC_ROUGHNESS_MAP)).bg;
#endif
#ifdef MATERIAL_OCCLUSION_MAP
    float occlusion = texture(occlusionTexture, coordinates(MATERIAL_OCCLUSION_MAP)).r;
    surface.z += materialFactors.w * (occlusion - 1.0);
#endif
    return surface;
}

void osgGpuAnimationMaterial(out vec4 baseColor, out vec3 emission, out vec3 metallicRoughnessOcclusion, out vec3 normal)
{
    baseColor = materialBaseColor();
    emission = materialEmissive();
    metallicRoughnessOcclusion = materialSurface();
    normal = materialNormal();
}
