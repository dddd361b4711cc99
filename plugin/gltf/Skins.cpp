// SPDX-License-Identifier: MIT
#include "gltf/Skins.h"

#include "gltf/Accessor.h"

namespace osgGpuAnimation::gltf
{

namespace
{

std::vector<AffineMatrix> readInverseBinds(const tinygltf::Model& model, const tinygltf::Skin& skin)
{
    std::vector<AffineMatrix> matrices(skin.joints.size());
    if (skin.inverseBindMatrices < 0) return matrices;
    const std::vector<float> numbers = readFloats(model, skin.inverseBindMatrices);
    for (std::size_t place = 0; place < matrices.size() && 16 * (place + 1) <= numbers.size(); ++place)
    {
        const float* columns = numbers.data() + 16 * place;
        for (std::size_t row = 0; row < 3; ++row)
            matrices[place].rows[row] = glm::vec4(columns[row], columns[4 + row], columns[8 + row], columns[12 + row]);
    }
    return matrices;
}

} // namespace

std::vector<Skin> readSkins(const tinygltf::Model& model, const Joints& joints)
{
    std::vector<Skin> skins;
    skins.reserve(model.skins.size());
    for (const tinygltf::Skin& source : model.skins)
    {
        Skin skin;
        skin.name = source.name;
        for (const int node : source.joints)
            skin.joints.push_back(joints.ofNode[static_cast<std::size_t>(node)]);
        skin.inverseBinds = readInverseBinds(model, source);
        skins.push_back(std::move(skin));
    }
    return skins;
}

} // namespace osgGpuAnimation::gltf
