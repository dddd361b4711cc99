// SPDX-License-Identifier: MIT
#pragma once

#include <osg/StateSet>
#include <osg/Texture2D>
#include <osg/Vec3>
#include <osg/Vec4>

#include <optional>

namespace osgGpuAnimation
{

/// glTF's metallic-roughness material (2.0, section 3.9) for the character program and the surface program:
///
///     PbrMaterial material;
///     material.metallic = 0.0f;
///     material.baseColorMap.texture = picture;
///     applyPbrMaterial(*mesh->getOrCreateStateSet(), material);
///     applyCharacterProgram(*mesh->getOrCreateStateSet());
///
/// Without it the two programs reproduce the fixed pipeline.
struct PbrMaterial
{
    /// A picture and the number of its texture coordinates: 0: of unit 0; 1, 2: the vertex attribute 9 (xy, zw).
    struct Map
    {
        /// Null: none. Its internal format: of sRGB maps GL_SRGB8 or GL_SRGB8_ALPHA8, of linear ones GL_RGB8 or
        /// GL_RGBA8.
        osg::ref_ptr<osg::Texture2D> texture;
        int coordinates = 0; ///< 0 to 2
    };

    osg::Vec4 baseColor{1, 1, 1, 1}; ///< linear, in [0, 1]
    float metallic = 1.0f;           ///< in [0, 1]
    float roughness = 1.0f;          ///< in [0, 1]; its square is the alpha of GGX
    float normalScale = 1.0f;        ///< of the map's first two components
    float occlusionStrength = 1.0f;  ///< in [0, 1]
    osg::Vec3 emissive{0, 0, 0};     ///< linear, in [0, 1]
    float emissiveStrength = 1.0f;   ///< KHR_materials_emissive_strength; 0 or more
    Map baseColorMap;                ///< sRGB; its coordinates are number 0
    Map metallicRoughnessMap;        ///< linear: green is roughness, blue is metallic
    Map normalMap;                   ///< linear
    Map occlusionMap;                ///< linear: red
    Map emissiveMap;                 ///< sRGB

    // KHR_materials_specular and ior: the dielectric's reflection along the normal (0.04: an index of refraction
    // of 1.5) and the weight of its reflection. isSpecularGlossiness: the converted
    // KHR_materials_pbrSpecularGlossiness.
    osg::Vec3 specularColor{0.04f, 0.04f, 0.04f}; ///< linear
    float specular = 1.0f;                        ///< in [0, 1]
    Map specularColorMap;                         ///< sRGB; isSpecularGlossiness: alpha is the glossiness
    Map specularMap;                              ///< linear: alpha
    bool isSpecularGlossiness = false;            ///< roughness is 1 - glossiness

    // KHR_materials_clearcoat
    float clearcoat = 0.0f;            ///< in [0, 1]
    float clearcoatRoughness = 0.0f;   ///< in [0, 1]
    Map clearcoatMap;                  ///< linear: red
    Map clearcoatRoughnessMap;         ///< linear: green
    float clearcoatNormalScale = 1.0f; ///< of the map's first two components
    Map clearcoatNormalMap;            ///< linear

    // KHR_materials_sheen
    osg::Vec3 sheenColor{0, 0, 0}; ///< linear, in [0, 1]
    float sheenRoughness = 0.0f;   ///< in [0, 1]
    Map sheenColorMap;             ///< sRGB
    Map sheenRoughnessMap;         ///< linear: alpha

    // KHR_materials_transmission: what lies behind is seen by blending, neither refracted nor coloured.
    float transmission = 0.0f; ///< in [0, 1]
    Map transmissionMap;       ///< linear: red
    bool isBlended = false;    ///< glTF's alpha mode BLEND: the alpha of the base colour counts, too

    /// Of those after emissiveMap that have an effect, in the order specularColorMap, clear coat, sheen, specularMap,
    /// transmission; the others are left out.
    static constexpr int maxExtensionMaps = 3;

    bool hasTangents = false;        ///< the meshes have the vertex attribute 4: xyz, and the bitangent's sign
    bool hasMoreCoordinates = false; ///< the meshes have the vertex attribute 9, see Map

    /// False for a map of clear coat, sheen or transmission while the factor that it multiplies is 0.
    bool hasEffect(Map PbrMaterial::*map) const;
};

/// Sets the material's textures, uniforms and shader defines, and an osg::Material with its colours, which materials
/// above may override. Replaces the material of an earlier call. Alpha modes and sides are not part of it; a material
/// with transmission is blended.
void applyPbrMaterial(osg::StateSet& stateSet, const PbrMaterial& material);
/// The material of the last applyPbrMaterial() with this StateSet, as far as it has an effect. Empty: it has none. The
/// textures are shared.
std::optional<PbrMaterial> pbrMaterialOf(const osg::StateSet& stateSet);

/// Lets the surface be drawn after opaque ones, the farthest first, over what lies behind, and without depths of its
/// own. sourceFactor: of glBlendFunc, GL_SRC_ALPHA, or GL_ONE if the colour is multiplied by alpha already.
void applyBlending(osg::StateSet& stateSet, GLenum sourceFactor);

/// A linear colour as an osg::Material and OSG's fixed pipeline show it: by the sRGB transfer function (IEC 61966-2-1),
/// clamped to [0, 1]. Alpha is linear in both.
osg::Vec4 displayColor(const osg::Vec4& linear);
/// The inverse of displayColor().
osg::Vec4 linearColor(const osg::Vec4& display);

} // namespace osgGpuAnimation
