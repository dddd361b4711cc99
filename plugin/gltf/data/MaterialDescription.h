// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A material of the file in words, for reports.
struct MaterialDescription
{
    struct Map
    {
        std::string use; ///< glTF's name without `Texture`: `baseColor`, `normal`, `clearcoatRoughness`
        int image = -1;  ///< of the file; -1: the texture has none
        int width = 0;   ///< pixels; 0: the picture is missing or cannot be read
        int height = 0;
    };

    std::string name;
    std::string alphaMode; ///< `OPAQUE`, `MASK` or `BLEND`
    double alphaCutoff = 0.5;
    bool doubleSided = false;
    bool unlit = false;
    std::vector<Map> maps; ///< those that the import knows
};

/// One for each material, in the file's order.
std::vector<MaterialDescription> describeMaterials(const tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
