// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/MaterialMaps.h"

#include <tiny_gltf.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The names of the file's variants (KHR_materials_variants), each different: a variant without a name is called
/// `variants[INDEX]`, and of equal names, later ones get a number.
std::vector<std::string> variantNames(const tinygltf::Model& model);

/// The materials of a primitive in all variants, and what its vertices need to be drawn with each of them.
struct PrimitiveMaterials
{
    int own = -1;                 ///< without a variant, and in variants that do not map the primitive; -1: the default
    std::map<int, int> ofVariant; ///< by variant: its material; only those that can be drawn
    /// Variants whose material reads other texture coordinates than the vertices have: the own material is drawn.
    std::vector<int> withoutCoordinates;
    std::vector<TextureCoordinates> coordinates; ///< those that a material reads are the first of these
    bool hasNormalMap = false;
    bool isBlended = false;     ///< in a variant: the order of the triangles counts
    bool isTransparent = false; ///< in a variant, blended or transmissive: OSG draws the farthest drawable first

    /// variant: -1: none.
    int materialIn(int variant) const
    {
        const auto found = ofVariant.find(variant);
        return found == ofVariant.end() ? own : found->second;
    }
};

/// visit: for the material of each mapping, with the numbers of its variants.
void forEachVariantMaterial(const tinygltf::Primitive& primitive,
                            const std::function<void(int material, const tinygltf::Value& variants)>& visit);
PrimitiveMaterials materialsOf(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                               MapsOfMaterials& maps);

} // namespace osgGpuAnimation::gltf
