// SPDX-License-Identifier: MIT
#include "Noise.h"

#include <glm/common.hpp>

#include <cstdint>

namespace osgGpuAnimation::scenes
{

namespace
{

/// A number in [-1, 1] for a lattice point, by integer hashing.
double lattice(std::int32_t x, std::int32_t y, std::int32_t z)
{
    std::uint32_t hash = static_cast<std::uint32_t>(x) * 0x8da6b343u + static_cast<std::uint32_t>(y) * 0xd8163841u +
                         static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
    hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
    hash = (hash ^ (hash >> 12)) * 0x297a2d39u;
    hash ^= hash >> 15;
    return hash / 2147483647.5 - 1.0;
}

} // namespace

double noise(const glm::dvec3& place)
{
    const glm::dvec3 cell = glm::floor(place);
    const glm::dvec3 inside = place - cell;
    const glm::dvec3 share = inside * inside * (3.0 - 2.0 * inside);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
        const int dx = corner & 1;
        const int dy = corner >> 1 & 1;
        const int dz = corner >> 2;
        const double weight =
            (dx ? share.x : 1.0 - share.x) * (dy ? share.y : 1.0 - share.y) * (dz ? share.z : 1.0 - share.z);
        sum += weight * lattice(static_cast<std::int32_t>(cell.x) + dx, static_cast<std::int32_t>(cell.y) + dy,
                                static_cast<std::int32_t>(cell.z) + dz);
    }
    return sum;
}

} // namespace osgGpuAnimation::scenes
