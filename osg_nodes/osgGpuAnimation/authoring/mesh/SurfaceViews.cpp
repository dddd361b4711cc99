// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/mesh/SurfaceViews.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr double margin = 0.1; ///< on each side, as a share of the surface: levels of detail may be larger

const std::array<glm::dvec3, SurfaceViews::viewCount / 2> axes{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};

double cross(const glm::dvec2& a, const glm::dvec2& b)
{
    return a.x * b.y - a.y * b.x;
}

} // namespace

SurfaceViews::SurfaceViews(const Poses& poses)
{
    for (std::size_t view = 0; view < viewCount; ++view)
    {
        Grid grid;
        grid.pose = poses.size() > 1 ? 1 + view % (poses.size() - 1) : 0;
        grid.towards = glm::normalize((view % 2 == 0 ? 1.0 : -1.0) * axes[view / 2]);
        const glm::dvec3 aside = std::abs(grid.towards.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
        grid.right = glm::normalize(glm::cross(aside, grid.towards));
        grid.up = glm::cross(grid.towards, grid.right);
        glm::dvec2 min(std::numeric_limits<double>::infinity()), max(-min);
        for (const glm::dvec3 position : poses[grid.pose])
        {
            const glm::dvec2 place(glm::dot(position, grid.right), glm::dot(position, grid.up));
            min = glm::min(min, place);
            max = glm::max(max, place);
        }
        const double side = std::max(max.x - min.x, max.y - min.y);
        grid.left = min.x - margin * side;
        grid.bottom = min.y - margin * side;
        grid.cell = (1.0 + 2.0 * margin) * side / cellsAcross;
        _grids.push_back(grid);
    }
}

std::vector<SurfaceViews::Seen> SurfaceViews::seen(std::size_t view, const Surface& surface) const
{
    const Grid& grid = _grids[view];
    std::vector<Seen> cells(cellsAcross * cellsAcross);
    if (!(grid.cell > 0.0)) return cells;
    const std::vector<glm::vec3>& positions = surface.poses[grid.pose];
    std::vector<double> nearest(cells.size(), -std::numeric_limits<double>::infinity());
    std::vector<glm::dvec3> placed; // column, row and height
    placed.reserve(positions.size());
    for (const glm::dvec3 position : positions)
        placed.emplace_back((glm::dot(position, grid.right) - grid.left) / grid.cell,
                            (glm::dot(position, grid.up) - grid.bottom) / grid.cell, glm::dot(position, grid.towards));
    for (std::uint32_t triangle = 0; 3 * triangle + 2 < surface.triangles.size(); ++triangle)
    {
        std::array<glm::dvec2, 3> places;
        std::array<double, 3> heights;
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            const glm::dvec3& place = placed[surface.triangles[3 * triangle + corner]];
            places[corner] = {place.x, place.y};
            heights[corner] = place.z;
        }
        const double area = cross(places[1] - places[0], places[2] - places[0]);
        if (area == 0.0 || (area < 0.0 && !surface.isTwoSided)) continue;
        const auto [left, right] = std::minmax({places[0].x, places[1].x, places[2].x});
        const auto [bottom, top] = std::minmax({places[0].y, places[1].y, places[2].y});
        const auto firstFrom = [](double place)
        { return static_cast<int>(std::clamp(std::ceil(place - 0.5), 0.0, 1.0 * cellsAcross)); };
        const auto lastTo = [](double place)
        { return static_cast<int>(std::clamp(std::floor(place - 0.5), -1.0, cellsAcross - 1.0)); };
        const int firstColumn = firstFrom(left), lastColumn = lastTo(right), lastRow = lastTo(top);
        for (int y = firstFrom(bottom); y <= lastRow; ++y)
            for (int x = firstColumn; x <= lastColumn; ++x)
            {
                const glm::dvec2 centre(x + 0.5, y + 0.5);
                const glm::dvec2 a = places[0] - centre, b = places[1] - centre, c = places[2] - centre;
                const glm::dvec3 areas(cross(b, c), cross(c, a), cross(a, b));
                if (area > 0.0 ? areas.x < 0.0 || areas.y < 0.0 || areas.z < 0.0
                               : areas.x > 0.0 || areas.y > 0.0 || areas.z > 0.0)
                    continue;
                const glm::dvec3 shares = areas / area;
                const double height = shares.x * heights[0] + shares.y * heights[1] + shares.z * heights[2];
                const auto cell = static_cast<std::size_t>(y * cellsAcross + x);
                if (!(height > nearest[cell])) continue;
                nearest[cell] = height;
                cells[cell] = {triangle, area > 0.0, glm::vec3(shares)};
            }
    }
    return cells;
}

std::size_t SurfaceViews::coveredCells(const Surface& surface) const
{
    std::size_t count = 0;
    for (std::size_t view = 0; view < viewCount; ++view)
        for (const Seen& cell : seen(view, surface))
            count += cell.triangle != Seen::none;
    return count;
}

std::vector<SurfaceViews::Cell> SurfaceViews::outlineOf(const std::vector<Seen>& cells)
{
    const auto isSeen = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < cellsAcross && y < cellsAcross && cells[indexOf({x, y})].triangle != Seen::none;
    };
    std::vector<Cell> outline;
    for (int y = 0; y < cellsAcross; ++y)
        for (int x = 0; x < cellsAcross; ++x)
            if (isSeen(x, y) && !(isSeen(x - 1, y) && isSeen(x + 1, y) && isSeen(x, y - 1) && isSeen(x, y + 1)))
                outline.emplace_back(x, y);
    return outline;
}

glm::vec3 SurfaceViews::wayBetween(std::size_t view, const Cell& from, const Cell& to) const
{
    const Grid& grid = _grids[view];
    const glm::dvec2 way = grid.cell * glm::dvec2(to - from);
    return glm::vec3(way.x * grid.right + way.y * grid.up);
}

} // namespace osgGpuAnimation
