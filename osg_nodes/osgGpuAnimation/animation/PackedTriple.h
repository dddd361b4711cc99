// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

namespace osgGpuAnimation
{

/// Three whole numbers of 20 bits and a place of 2 bits in 8 bytes: a rotation, translation or scale of a compact clip,
/// with the same layout on the GPU (layout.glsl, mix.glsl).
struct PackedTriple
{
    std::uint32_t low = 0;
    std::uint32_t high = 0;

    static constexpr std::uint32_t largest = (1u << 20) - 1;

    /// numbers: each in [0, largest]; place in [0, 3].
    static PackedTriple of(const glm::uvec3& numbers, std::uint32_t place);
    glm::uvec3 numbers() const;
    std::uint32_t place() const { return high >> 28; }

    /// A rotation by its three smallest components, place being that of the largest: off by at most 7e-7 a component.
    /// q: not of length 0.
    static PackedTriple ofRotation(const glm::vec4& q);
    glm::vec4 rotation() const; ///< unit
};

} // namespace osgGpuAnimation
