// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/lod/Silhouettes.h>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

constexpr int cellsAcross = 96;
constexpr double gridMargin = 0.1; ///< on each side, as a share of the silhouette: levels may be larger

const glm::dvec3 viewAxes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

class CoveredCells
{
public:
    /// a, b, c: in cells.
    void add(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
    {
        const double area = cross(b - a, c - a);
        if (!(area > 0.0)) return; // faces away
        const int bottom = firstAbove(std::min({a.y, b.y, c.y})), top = lastBelow(std::max({a.y, b.y, c.y}));
        const int left = firstAbove(std::min({a.x, b.x, c.x})), right = lastBelow(std::max({a.x, b.x, c.x}));
        for (int y = bottom; y <= top; ++y)
            for (int x = left; x <= right; ++x)
            {
                const glm::dvec2 centre(x + 0.5, y + 0.5);
                if (cross(b - a, centre - a) >= 0.0 && cross(c - b, centre - b) >= 0.0 &&
                    cross(a - c, centre - c) >= 0.0)
                    _cells[static_cast<std::size_t>(y * cellsAcross + x)] = true;
            }
    }

    double count() const { return static_cast<double>(std::count(_cells.begin(), _cells.end(), true)); }

private:
    static double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }
    static int firstAbove(double place)
    {
        return static_cast<int>(std::clamp(std::ceil(place - 0.5), 0.0, 1.0 * cellsAcross));
    }
    static int lastBelow(double place)
    {
        return static_cast<int>(std::clamp(std::floor(place - 0.5), -1.0, cellsAcross - 1.0));
    }

    std::vector<bool> _cells = std::vector<bool>(cellsAcross * cellsAcross);
};

} // namespace

Silhouettes::Silhouettes(const Poses& poses)
{
    for (std::size_t pose = 0; pose < poses.size(); ++pose)
        for (const glm::dvec3& axis : viewAxes)
        {
            const glm::dvec3 towards = glm::normalize(axis);
            const glm::dvec3 aside = std::abs(towards.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
            Grid grid{pose, glm::normalize(glm::cross(aside, towards)), {}, 0.0, 0.0, 0.0};
            grid.up = glm::cross(towards, grid.right);
            glm::dvec2 least(std::numeric_limits<double>::infinity()), most = -least;
            for (const glm::dvec3 place : poses[pose])
            {
                const glm::dvec2 seen(glm::dot(place, grid.right), glm::dot(place, grid.up));
                least = glm::dvec2(std::min(least.x, seen.x), std::min(least.y, seen.y));
                most = glm::dvec2(std::max(most.x, seen.x), std::max(most.y, seen.y));
            }
            const double side = (1.0 + 2.0 * gridMargin) * std::max(most.x - least.x, most.y - least.y);
            grid.cell = side / cellsAcross;
            grid.left = 0.5 * (least.x + most.x - side);
            grid.bottom = 0.5 * (least.y + most.y - side);
            if (side > 0.0) _grids.push_back(grid);
        }
}

double Silhouettes::meanArea(const Poses& poses, const std::vector<std::uint32_t>& indices) const
{
    double sum = 0.0;
    std::vector<glm::dvec2> seen;
    for (const Grid& grid : _grids)
    {
        seen.clear();
        for (const glm::dvec3 place : poses[grid.pose])
            seen.emplace_back((glm::dot(place, grid.right) - grid.left) / grid.cell,
                              (glm::dot(place, grid.up) - grid.bottom) / grid.cell);
        CoveredCells covered;
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
            covered.add(seen[indices[i]], seen[indices[i + 1]], seen[indices[i + 2]]);
        sum += covered.count() * grid.cell * grid.cell;
    }
    return _grids.empty() ? 0.0 : sum / static_cast<double>(_grids.size());
}

} // namespace osgGpuAnimation
