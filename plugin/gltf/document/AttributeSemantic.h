// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// The parsed name of a vertex attribute (glTF 2.0, section 3.7.2.1): TEXCOORD_1 is set 1 of TexCoord.
struct AttributeSemantic
{
    enum class Kind : std::uint8_t
    {
        Position,
        Normal,
        Tangent,
        TexCoord,
        Color,
        Joints,
        Weights,
        Custom ///< begins with an underscore: the application's own
    };
    static constexpr int maxSets = 32; ///< sets from 0 to 31: more than any file has

    Kind kind = Kind::Custom;
    int set = 0;

    /// None if glTF defines no such name: TEXCOORD_x, COLOR_01, JOINTS_2000000000.
    static std::optional<AttributeSemantic> parse(std::string_view name);
};

/// Where a primitive uses an attribute: a morph target allows other types, and KHR_mesh_quantization allows more.
struct AttributePlace
{
    bool isMorphTarget = false;
    bool isQuantized = false;
};

/// Empty if the attribute may have the accessor's type and components (glTF 2.0, section 3.7.2.1 and 3.7.2.2;
/// KHR_mesh_quantization), else the expected ones: `VEC3 of float`.
std::string wrongAttributeFormat(const tinygltf::Accessor& accessor, AttributeSemantic::Kind kind,
                                 AttributePlace place);

/// The type and components of an accessor: `VEC2 of normalized unsigned short`.
std::string formatText(const tinygltf::Accessor& accessor);

} // namespace osgGpuAnimation::gltf
