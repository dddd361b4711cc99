// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// The vertices of a mesh as several poses have them: what SurfaceReduction goes by.
struct PosedSurface
{
    std::vector<std::vector<glm::vec3>> poses; ///< one pose and more: positions, one a vertex
    std::vector<glm::vec3> normals;            ///< one a vertex, or none
    std::vector<glm::vec2> texCoords;          ///< one a vertex, or none

    std::size_t vertexCount() const { return poses.front().size(); }
};

} // namespace osgGpuAnimation
