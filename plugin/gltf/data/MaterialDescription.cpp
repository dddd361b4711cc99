// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialDescription.h"

#include "gltf/data/MaterialMaps.h"
#include "gltf/file/Elements.h"

namespace osgGpuAnimation::gltf
{

namespace
{

MaterialDescription::Map describeMap(const tinygltf::Model& model, const MaterialMap& map)
{
    const std::string member = map.member;
    MaterialDescription::Map description;
    description.use = member.substr(0, member.rfind("Texture"));
    description.image = elementOf(model.textures, map.texture).source;
    if (description.image < 0) return description;
    const tinygltf::Image& image = elementOf(model.images, description.image);
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
