// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace osgGpuAnimation
{

/// Orthographic views of a surface along the axes and diagonals of space, each on a grid of cells around it: what is
/// visible of the surface, and how much of each view it covers. Coarse levels of detail are fitted to these views.
///
///     const SurfaceViews views(positions);
///     const std::vector<SurfaceViews::Seen> seen = views.seen(0, {positions, indices, false});
class SurfaceViews
{
public:
    static constexpr std::size_t viewCount = 14;
    static constexpr int cellsAcross = 96;

    struct Surface
    {
        const std::vector<glm::vec3>& positions;     ///< finite
        const std::vector<std::uint32_t>& triangles; ///< three positions each
        bool isTwoSided;                             ///< false: triangles that face away are not visible
    };
    /// The nearest triangle at the centre of a cell.
    struct Seen
    {
        static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

        std::uint32_t triangle = none;
        bool isFront = true;         ///< its corners are counter-clockwise in the view
        glm::vec3 barycentric{0.0f}; ///< of the cell's centre, by corner
    };

    /// The grids contain the positions and a margin of a tenth on each side. positions: at least one, finite.
    explicit SurfaceViews(const std::vector<glm::vec3>& positions);

    /// The direction to the viewer, of length 1.
    glm::vec3 towards(std::size_t view) const { return glm::vec3(_grids[view].towards); }
    double cellSize(std::size_t view) const { return _grids[view].cell; } ///< the length of a cell's side
    /// One element per cell of a view, in [0, viewCount).
    std::vector<Seen> seen(std::size_t view, const Surface& surface) const;
    /// The number of cells of all views that the surface covers.
    std::size_t coveredCells(const Surface& surface) const;

private:
    struct Grid
    {
        glm::dvec3 right, up, towards; ///< of length 1; towards: the viewer
        double left, bottom;
        double cell; ///< the length of a side; 0: all positions are in one point
    };

    std::vector<Grid> _grids;
};

} // namespace osgGpuAnimation
