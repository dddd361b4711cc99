// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialVariants.h"

#include <algorithm>
#include <set>

namespace osgGpuAnimation::gltf
{

namespace
{

const char* const variantsName = "KHR_materials_variants";

/// An empty value if the extension has no such member.
const tinygltf::Value& memberOf(const tinygltf::ExtensionMap& extensions, const char* member)
{
    static const tinygltf::Value none;
    const auto extension = extensions.find(variantsName);
    return extension == extensions.end() || !extension->second.Has(member) ? none : extension->second.Get(member);
}

/// Takes the material's coordinates if they begin like the known ones, or the known ones like these.
bool takeCoordinates(const std::vector<TextureCoordinates>& wanted, std::vector<TextureCoordinates>& known)
{
    const std::size_t common = std::min(wanted.size(), known.size());
    if (!std::equal(wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(common), known.begin())) return false;
    if (wanted.size() > known.size()) known = wanted;
    return true;
}

/// False, and no change, if the vertices cannot have the coordinates of the material too.
bool add(const tinygltf::Material& material, const MaterialMaps& maps, PrimitiveMaterials& materials)
{
    if (!takeCoordinates(maps.coordinates, materials.coordinates)) return false;
    materials.hasNormalMap |= maps.find(&PbrMaterial::normalMap) != nullptr;
    materials.isBlended |= material.alphaMode == "BLEND";
    return true;
}

} // namespace

std::vector<std::string> variantNames(const tinygltf::Model& model)
{
    const tinygltf::Value& variants = memberOf(model.extensions, "variants");
    std::vector<std::string> names;
    std::set<std::string> taken{""};
    for (std::size_t i = 0; i < variants.ArrayLen(); ++i)
    {
        const tinygltf::Value& variant = variants.Get(static_cast<int>(i));
        std::string name = variant.Has("name") ? variant.Get("name").Get<std::string>() : std::string();
        if (!taken.insert(name).second) name = "variants[" + std::to_string(i) + "]";
        names.push_back(std::move(name));
    }
    return names;
}

PrimitiveMaterials materialsOf(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                               MapsOfMaterials& maps)
{
    PrimitiveMaterials materials;
    const auto addMaterial = [&](int index)
    { return add(model.materials[static_cast<std::size_t>(index)], maps.of(index), materials); };
    materials.own = primitive.material;
    if (materials.own >= 0) addMaterial(materials.own);
    const tinygltf::Value& mappings = memberOf(primitive.extensions, "mappings");
    for (std::size_t i = 0; i < mappings.ArrayLen(); ++i)
    {
        const tinygltf::Value& mapping = mappings.Get(static_cast<int>(i));
        if (!mapping.Has("material")) continue;
        const int material = mapping.Get("material").GetNumberAsInt();
        const tinygltf::Value& variants = mapping.Get("variants");
        const bool fits = addMaterial(material);
        for (std::size_t v = 0; v < variants.ArrayLen(); ++v)
        {
            const int variant = variants.Get(static_cast<int>(v)).GetNumberAsInt();
            if (fits)
                materials.ofVariant.emplace(variant, material);
            else
                materials.withoutCoordinates.push_back(variant);
        }
    }
    return materials;
}

} // namespace osgGpuAnimation::gltf
