// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/authoring/mesh/MeshConnectivity.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace osgGpuAnimation
{

/// Orthographic views of a surface along the axes of space and between two of them, each of another pose, on a grid of
/// cells around it: what is visible of the surface, and how much of each view it covers. Coarse levels of detail are
/// fitted to these views.
///
///     const SurfaceViews views(poses);
///     const std::vector<SurfaceViews::Seen> seen = views.seen(0, {poses, indices, false});
class SurfaceViews
{
public:
    static constexpr std::size_t viewCount = 18;
    static constexpr int cellsAcross = 96;
    static constexpr std::size_t poseCount = 1 + viewCount; ///< views show none but the first poses

    using Poses = PosedSurface::Poses; ///< finite

    struct Surface
    {
        const Poses& poses;                          ///< as many as those of the constructor, or poseCount
        const std::vector<std::uint32_t>& triangles; ///< three vertices each
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

    /// The grids contain the positions and a margin of a tenth on each side. poses: at least one, of at least one
    /// vertex.
    explicit SurfaceViews(const Poses& poses);

    /// The pose that a view shows: each another one after the first, if there are so many.
    std::size_t poseOf(std::size_t view) const { return _grids[view].pose; }

    /// The direction to the viewer, of length 1.
    glm::vec3 towards(std::size_t view) const { return glm::vec3(_grids[view].towards); }
    double cellSize(std::size_t view) const { return _grids[view].cell; } ///< the length of a cell's side
    /// One element per cell of a view, in [0, viewCount).
    std::vector<Seen> seen(std::size_t view, const Surface& surface) const;
    /// The number of cells of all views that the surface covers.
    std::size_t coveredCells(const Surface& surface) const;
    /// A cell of a view: its column and its row.
    using Cell = glm::ivec2;
    static std::size_t indexOf(const Cell& cell) { return static_cast<std::size_t>(cell.y * cellsAcross + cell.x); }
    /// The visible cells that have a neighbour that is not, row by row. cells: of a view.
    static std::vector<Cell> outlineOf(const std::vector<Seen>& cells);
    /// The way between the centres of two cells of a view.
    glm::vec3 wayBetween(std::size_t view, const Cell& from, const Cell& to) const;

private:
    struct Grid
    {
        std::size_t pose;
        glm::dvec3 right, up, towards; ///< of length 1; towards: the viewer
        double left, bottom;
        double cell; ///< the length of a side; 0: all positions are in one point
    };

    std::vector<Grid> _grids;
};

} // namespace osgGpuAnimation
