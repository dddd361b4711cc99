// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// The mean area of the silhouettes of a surface, seen along seven axes (the three axes of space and the four
/// diagonals), in the poses' units squared. Only triangles that face the viewer count. The area is measured on a grid
/// of 96 x 96 cells around each silhouette: levels of detail are compared with the surface that they replace.
///
///     const Silhouettes silhouettes(poses);                    // the grids
///     const double area = silhouettes.meanArea(poses, indices);
///     const double ofLevel = silhouettes.meanArea(posesOfLevel, indicesOfLevel);
class Silhouettes
{
public:
    using Poses = std::vector<std::vector<glm::vec3>>;

    /// poses: those of the surface to compare with; each has at least one position, all finite.
    explicit Silhouettes(const Poses& poses);

    /// poses: as many as those of the constructor, one position per vertex. indices: whole triangles of the vertices.
    double meanArea(const Poses& poses, const std::vector<std::uint32_t>& indices) const;

private:
    struct Grid
    {
        std::size_t pose;
        glm::dvec3 right, up; ///< of the view, of length 1
        double left, bottom;
        double cell; ///< the length of a side
    };

    std::vector<Grid> _grids;
};

} // namespace osgGpuAnimation
