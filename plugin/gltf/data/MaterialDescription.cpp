// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialDescription.h"

#include "gltf/data/MaterialMaps.h"
#include "gltf/file/Elements.h"

namespace osgGpuAnimation::gltf
{

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
        {
            const std::string member = map.member;
            const int source = elementOf(model.textures, map.texture).source;
            const tinygltf::Image none, &image = source < 0 ? none : elementOf(model.images, source);
            const bool isRead = !image.image.empty();
            description.maps.push_back({member.substr(0, member.rfind("Texture")), source, isRead ? image.width : 0,
                                        isRead ? image.height : 0});
        }
    }
    return descriptions;
}

} // namespace osgGpuAnimation::gltf
