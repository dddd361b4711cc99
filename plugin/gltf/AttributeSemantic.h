// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// The name of a vertex attribute, taken apart (glTF 2.0, section 3.7.2.1): TEXCOORD_1 is set 1 of TexCoord.
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
    static constexpr int mostSets = 32; ///< sets from 0 to 31: more than any file has

    Kind kind = Kind::Custom;
    int set = 0;

    /// None where glTF knows no such name: TEXCOORD_x, COLOR_01, JOINTS_2000000000.
    static std::optional<AttributeSemantic> parse(std::string_view name);
};

} // namespace osgGpuAnimation::gltf
