// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/TextureCoordinates.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <tiny_gltf.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Whether a material shows a map.
enum class MapUse
{
    Shown,
    WithoutEffect, ///< the factor of its extension is 0
    NoCoordinates, ///< a vertex has no room for its texture coordinates
    NoTextureUnit, ///< beyond PbrMaterial::maxExtensionMaps
};

/// One map of a material.
struct MaterialMap
{
    const char* member;                   ///< glTF's name of it, like `normalTexture`
    PbrMaterial::Map PbrMaterial::*place; ///< its place in the result
    int texture = -1;                     ///< of the file
    bool isColor = false;                 ///< sRGB, else data
    MapUse use = MapUse::Shown;
    int number = -1;        ///< index into MaterialMaps::coordinates; -1: not shown
    std::string animated{}; ///< the texture's name in PropertyMember if clips animate its transform; else empty
};

/// The maps of a material and the different texture coordinates that they read.
struct MaterialMaps
{
    static constexpr std::size_t maxCoordinates = 3; ///< a vertex has that many; earlier maps come first

    std::vector<MaterialMap> maps;               ///< the base colour first
    std::vector<TextureCoordinates> coordinates; ///< at most maxCoordinates; number 0 is that of the base colour

    /// True if one that is shown reads tangents.
    bool hasNormalMap() const;
};

/// Those of glTF 2.0, section 3.9, and of the material extensions, those of an extension in PbrMaterial's order.
/// allMaps: false considers the base colour alone. isAnimated: true for the names (see PropertyMember) of textures
/// whose transform clips animate.
MaterialMaps mapsOf(const tinygltf::Material& material, bool allMaps,
                    const std::function<bool(const std::string&)>& isAnimated = {});

/// The maps of a file's materials, each computed once, when first asked for.
class MapsOfMaterials
{
public:
    /// allMaps: see mapsOf(). The model must outlive this.
    MapsOfMaterials(const tinygltf::Model& model, bool allMaps) : _model(model), _allMaps(allMaps) {}

    /// -1: the default material, which has none.
    const MaterialMaps& of(int material);

private:
    const tinygltf::Model& _model;
    const bool _allMaps;
    std::map<int, MaterialMaps> _maps;
};

/// The linear base colour factor, or the diffuse factor of KHR_materials_pbrSpecularGlossiness.
osg::Vec4 baseColorOf(const tinygltf::Material& material);

/// The factors of KHR_materials_emissive_strength, ior, specular, clearcoat, sheen, transmission and
/// pbrSpecularGlossiness but for its base colour, whose members the schema has checked. An unlit material has no
/// transmission.
void readMaterialExtensions(const tinygltf::Material& material, PbrMaterial& outMaterial);

/// One number a material: bit n is set where one of its textures reads TEXCOORD_n, KHR_texture_transform considered.
std::vector<std::uint32_t> materialCoordinates(const tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
