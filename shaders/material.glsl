// SPDX-License-Identifier: MIT
// The values of glTF's material (2.0, section 3.9) at a fragment. To use them in another program, link this shader, see
// materialShader() in looks/CharacterProgram.h, declare
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
#pragma import_defines(MATERIAL_MORE_COORDINATES, MATERIAL_GLOSSINESS, MATERIAL_SPECULAR, MATERIAL_SPECULAR_COLOR_MAP)
#pragma import_defines(MATERIAL_SPECULAR_MAP, MATERIAL_CLEARCOAT, MATERIAL_CLEARCOAT_MAP, MATERIAL_CLEARCOAT_ROUGHNESS_MAP)
#pragma import_defines(MATERIAL_CLEARCOAT_NORMAL_MAP, MATERIAL_SHEEN, MATERIAL_SHEEN_COLOR_MAP)
#pragma import_defines(MATERIAL_SHEEN_ROUGHNESS_MAP, MATERIAL_TRANSMISSION, MATERIAL_TRANSMISSION_MAP)

#ifndef DRAW_TEXTURE
#define DRAW_TEXTURE 1
#define DRAW_FLAT_NORMALS 0
#endif

uniform sampler2D baseColorTexture; // sRGB with MATERIAL_PBR
uniform sampler2D metallicRoughnessTexture;
uniform sampler2D normalTexture;
uniform sampler2D occlusionTexture;
uniform sampler2D emissiveTexture; // sRGB
uniform sampler2D specularColorTexture; // sRGB
uniform sampler2D specularTexture;

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

// The unperturbed normal; on back faces it points away from the viewer.
vec3 meshNormal()
{
#if DRAW_FLAT_NORMALS
    vec3 normal = normalize(cross(dFdx(viewPosition), dFdy(viewPosition)));
    return gl_FrontFacing ? normal : -normal;
#else
    float square = dot(viewNormal, viewNormal);
    if (square > 0.0) return viewNormal * inversesqrt(square);
    return vec3(0.0, 0.0, gl_FrontFacing ? 1.0 : -1.0); // of length 0: towards the viewer
#endif
}

// The unperturbed normal, towards the viewer.
vec3 facingNormal()
{
    vec3 normal = meshNormal();
    return gl_FrontFacing ? normal : -normal;
}

// The normal of a map, in eye space. map: in [-1, 1]. Without tangents, the derivatives of position and coordinates replace
// them (Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU", 2010). The second coordinate grows with the map's +Y.
vec3 mappedNormal(vec3 map, vec2 place)
{
    vec3 normal = meshNormal();
    float facing = gl_FrontFacing ? 1.0 : -1.0;
#ifdef MATERIAL_TANGENTS
    vec3 tangent = viewTangent.xyz;
    vec3 bitangent = viewTangent.w * cross(normal, tangent);
    map.xy *= facing;
#else
    vec3 alongX = cross(dFdy(viewPosition), normal);
    vec3 alongY = cross(normal, dFdx(viewPosition));
    vec2 placeX = dFdx(place);
    vec2 placeY = dFdy(place);
    vec3 tangent = alongX * placeX.x + alongY * placeY.x;
    vec3 bitangent = alongX * placeX.y + alongY * placeY.y;
#endif
    float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    if (!(longest > 0.0)) return facing * normal;
    map.xy *= inversesqrt(longest);
    return normalize(map.x * tangent + map.y * bitangent + map.z * facing * normal);
}

vec3 materialNormal()
{
#ifdef MATERIAL_NORMAL_MAP
    vec2 place = coordinates(MATERIAL_NORMAL_MAP);
    vec3 map = texture(normalTexture, place).xyz * 2.0 - 1.0;
    return mappedNormal(vec3(map.xy * materialFactors.z, map.z), place);
#else
    return facingNormal();
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
#if defined(MATERIAL_GLOSSINESS) && defined(MATERIAL_SPECULAR_COLOR_MAP)
    surface.y = 1.0 - (1.0 - surface.y) * texture(specularColorTexture, coordinates(MATERIAL_SPECULAR_COLOR_MAP)).a;
#endif
#ifdef MATERIAL_METALLIC_ROUGHNESS_MAP
    surface.xy *= texture(metallicRoughnessTexture, coordinates(MATERIAL_METALLIC_ROUGHNESS_MAP)).bg;
#endif
#ifdef MATERIAL_OCCLUSION_MAP
    float occlusion = texture(occlusionTexture, coordinates(MATERIAL_OCCLUSION_MAP)).r;
    surface.z += materialFactors.w * (occlusion - 1.0);
#endif
    return surface;
}

#ifdef MATERIAL_SPECULAR
uniform vec4 materialSpecular; // the colour reflected along the normal, and the reflection's weight
// The same, with their maps.
vec4 materialSpecularColor()
{
    vec4 specular = materialSpecular;
#ifdef MATERIAL_SPECULAR_COLOR_MAP
    specular.rgb *= texture(specularColorTexture, coordinates(MATERIAL_SPECULAR_COLOR_MAP)).rgb;
#endif
#ifdef MATERIAL_SPECULAR_MAP
    specular.a *= texture(specularTexture, coordinates(MATERIAL_SPECULAR_MAP)).a;
#endif
    return specular;
}
#endif

#ifdef MATERIAL_CLEARCOAT
uniform vec3 materialClearcoat; // weight, roughness, scale of the normal map
uniform sampler2D clearcoatTexture;
uniform sampler2D clearcoatRoughnessTexture;
uniform sampler2D clearcoatNormalTexture;
// Weight and roughness of the clear coat, and its normal.
vec2 materialCoat(out vec3 normal)
{
    vec2 coat = materialClearcoat.xy;
#ifdef MATERIAL_CLEARCOAT_MAP
    coat.x *= texture(clearcoatTexture, coordinates(MATERIAL_CLEARCOAT_MAP)).r;
#endif
#ifdef MATERIAL_CLEARCOAT_ROUGHNESS_MAP
    coat.y *= texture(clearcoatRoughnessTexture, coordinates(MATERIAL_CLEARCOAT_ROUGHNESS_MAP)).g;
#endif
#ifdef MATERIAL_CLEARCOAT_NORMAL_MAP
    vec2 place = coordinates(MATERIAL_CLEARCOAT_NORMAL_MAP);
    vec3 map = texture(clearcoatNormalTexture, place).xyz * 2.0 - 1.0;
    normal = mappedNormal(vec3(map.xy * materialClearcoat.z, map.z), place);
#else
    normal = facingNormal();
#endif
    return coat;
}
#endif

#ifdef MATERIAL_SHEEN
uniform vec4 materialSheen; // colour, roughness
uniform sampler2D sheenColorTexture;
uniform sampler2D sheenRoughnessTexture;
// The same, with their maps.
vec4 materialSheenColor()
{
    vec4 sheen = materialSheen;
#ifdef MATERIAL_SHEEN_COLOR_MAP
    sheen.rgb *= texture(sheenColorTexture, coordinates(MATERIAL_SHEEN_COLOR_MAP)).rgb;
#endif
#ifdef MATERIAL_SHEEN_ROUGHNESS_MAP
    sheen.a *= texture(sheenRoughnessTexture, coordinates(MATERIAL_SHEEN_ROUGHNESS_MAP)).a;
#endif
    return sheen;
}
#endif

#ifdef MATERIAL_TRANSMISSION
uniform float materialTransmission;
uniform sampler2D transmissionTexture;
float materialTransmittance()
{
    float share = materialTransmission;
#ifdef MATERIAL_TRANSMISSION_MAP
    share *= texture(transmissionTexture, coordinates(MATERIAL_TRANSMISSION_MAP)).r;
#endif
    return share;
}
#endif

void osgGpuAnimationMaterial(out vec4 baseColor, out vec3 emission, out vec3 metallicRoughnessOcclusion, out vec3 normal)
{
    baseColor = materialBaseColor();
    emission = materialEmissive();
    metallicRoughnessOcclusion = materialSurface();
    normal = materialNormal();
}
