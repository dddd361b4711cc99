// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialVariants.h"

#include "gltf/data/UniqueNames.h"
#include "gltf/file/Elements.h"

#include <algorithm>

namespace osgGpuAnimation::gltf
{

namespace
{

const char* const variantsName = "KHR_materials_variants";

/// An empty value if the extension has no such member.
const tinygltf::Value& memberOf(const tinygltf::ExtensionMap& extensions, const char* member)
{
    const tinygltf::Value& extension = extensionOf(extensions, variantsName);
    return extension.IsObject() ? extension.Get(member) : extension;
}

/// False, and no change, if the vertices cannot have the coordinates of the material, too: they begin like the known
/// ones, or the known ones like these.
bool add(const tinygltf::Material& material, const MaterialMaps& maps, PrimitiveMaterials& materials)
{
    const std::vector<TextureCoordinates>& wanted = maps.coordinates;
    const auto common = static_cast<std::ptrdiff_t>(std::min(wanted.size(), materials.coordinates.size()));
    if (!std::equal(wanted.begin(), wanted.begin() + common, materials.coordinates.begin())) return false;
    if (wanted.size() > materials.coordinates.size()) materials.coordinates = wanted;
    materials.hasNormalMap |= maps.hasNormalMap();
    materials.isBlended |= material.alphaMode == "BLEND";
    materials.isTransparent |= materials.isBlended || material.extensions.count("KHR_materials_transmission") > 0;
    return true;
}

} // namespace

std::vector<std::string> variantNames(const tinygltf::Model& model)
{
    const tinygltf::Value& variants = memberOf(model.extensions, "variants");
    UniqueNames unique;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < variants.ArrayLen(); ++i)
    {
        const tinygltf::Value& variant = variants.Get(static_cast<int>(i));
        const std::string name = variant.Has("name") ? variant.Get("name").Get<std::string>() : std::string();
        names.push_back(unique.unique(name.empty() ? "variants[" + std::to_string(i) + "]" : name));
    }
    return names;
}

void forEachVariantMaterial(const tinygltf::Primitive& primitive,
                            const std::function<void(int material, const tinygltf::Value& variants)>& visit)
{
    const tinygltf::Value& mappings = memberOf(primitive.extensions, "mappings");
    for (std::size_t i = 0; i < mappings.ArrayLen(); ++i)
        if (const tinygltf::Value& mapping = mappings.Get(static_cast<int>(i)); mapping.Has("material"))
            visit(mapping.Get("material").GetNumberAsInt(), mapping.Get("variants"));
}

PrimitiveMaterials materialsOf(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                               MapsOfMaterials& maps)
{
    PrimitiveMaterials materials;
    const auto addMaterial = [&](int index)
    { return add(elementOf(model.materials, index), maps.of(index), materials); };
    materials.own = primitive.material;
    if (materials.own >= 0) addMaterial(materials.own);
    const auto addVariants = [&](int material, const tinygltf::Value& variants)
    {
        const bool fits = addMaterial(material);
        for (std::size_t v = 0; v < variants.ArrayLen(); ++v)
        {
            const int variant = variants.Get(static_cast<int>(v)).GetNumberAsInt();
            if (fits)
                materials.ofVariant.emplace(variant, material);
            else
                materials.withoutCoordinates.push_back(variant);
        }
    };
    forEachVariantMaterial(primitive, addVariants);
    return materials;
}

} // namespace osgGpuAnimation::gltf
