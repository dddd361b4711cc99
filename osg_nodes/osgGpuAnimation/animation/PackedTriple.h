// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

namespace osgGpuAnimation
{

/// Three integers of 20 bits and an index of 2 bits in 8 bytes: a rotation, translation or scale of a compact clip. The
/// GPU uses the same layout (layout.glsl, mix.glsl).
struct PackedTriple
{
    std::uint32_t low = 0;
    std::uint32_t high = 0;

    static constexpr std::uint32_t largest = (1u << 20) - 1;

    /// numbers: each in [0, largest]. place: in [0, 3].
    static PackedTriple of(const glm::uvec3& numbers, std::uint32_t place);
    glm::uvec3 numbers() const;
    std::uint32_t place() const { return high >> 28; }

    /// Stores the three smallest components of a rotation; place is the index of the largest one. The error is at most
    /// 7e-7 per component. q: of a length above 0.
    static PackedTriple ofRotation(const glm::vec4& q);
    glm::vec4 rotation() const; ///< unit
};

} // namespace osgGpuAnimation
