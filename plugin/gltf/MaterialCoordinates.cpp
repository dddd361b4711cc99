// SPDX-License-Identifier: MIT
#include "gltf/MaterialCoordinates.h"

namespace osgGpuAnimation::gltf
{

namespace
{

template <typename TextureInfo>
std::uint32_t bitOf(const TextureInfo& texture)
{
    if (texture.index < 0) return 0;
    int set = texture.texCoord;
    const auto transform = texture.extensions.find("KHR_texture_transform");
    if (transform != texture.extensions.end() && transform->second.Has("texCoord"))
        set = transform->second.Get("texCoord").GetNumberAsInt();
    return std::uint32_t(1) << set; // sets are below 32: the schema sees to it
}

} // namespace

std::vector<std::uint32_t> materialCoordinates(const tinygltf::Model& model)
{
    std::vector<std::uint32_t> sets;
    for (const tinygltf::Material& material : model.materials)
        sets.push_back(bitOf(material.pbrMetallicRoughness.baseColorTexture) |
                       bitOf(material.pbrMetallicRoughness.metallicRoughnessTexture) | bitOf(material.normalTexture) |
                       bitOf(material.occlusionTexture) | bitOf(material.emissiveTexture));
    return sets;
}

} // namespace osgGpuAnimation::gltf
