// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialDescription.h"

#include "gltf/data/MaterialMaps.h"

namespace osgGpuAnimation::gltf
{

namespace
{

MaterialDescription::Map describeMap(const tinygltf::Model& model, const MaterialMap& map)
{
    const std::string member = map.member;
    MaterialDescription::Map description;
    description.use = member.substr(0, member.rfind("Texture"));
    description.image = model.textures[static_cast<std::size_t>(map.texture)].source;
    if (description.image < 0) return description;
    const tinygltf::Image& image = model.images[static_cast<std::size_t>(description.image)];
    if (image.image.empty()) return description;
    description.width = image.width;
    description.height = image.height;
    return description;
}

} // namespace

std::vector<MaterialDescription> describeMaterials(const tinygltf::Model& model)
{
    std::vector<MaterialDescription> descriptions;
    for (const tinygltf::Material& material : model.materials)
    {
        MaterialDescription& description = descriptions.emplace_back();
        description.name = material.name;
        description.alphaMode = material.alphaMode;
        description.alphaCutoff = material.alphaCutoff;
        description.doubleSided = material.doubleSided;
        description.unlit = material.extensions.count("KHR_materials_unlit") > 0;
        for (const MaterialMap& map : mapsOf(material, true).maps)
            description.maps.push_back(describeMap(model, map));
    }
    return descriptions;
}

} // namespace osgGpuAnimation::gltf
