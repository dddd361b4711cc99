// SPDX-License-Identifier: MIT
#pragma once

#include "support/MadeLevels.h"

#include <osgGpuAnimation/authoring/mesh/MeshConnectivity.h>
#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace osgGpuAnimation
{

/// What a character shows at a level of detail in a pose, by the CPU twin in double precision, to measure how far the
/// vertices of its meshes are from it. In the set's units.
///
///     const ShownSurface surface(character, set, levels, level, shownPalette);
///     EXPECT_LE(surface.largestDistance(exactPalette), levels->foundError(level));
class ShownSurface
{
public:
    /// merged: of the meshes among the group's children; null: each has levels of its own. Meshes that are drawn with a
    /// callback show nothing.
    ShownSurface(const osg::Group& meshes, const AnimationSet& set, const CharacterLevels* merged, int level,
                 const std::vector<AffineMatrix>& palette)
        : _meshes(meshes)
    {
        std::set<const SkinnedGeometry*> parts;
        forEachMesh(meshes, [&](const SkinnedGeometry& mesh) { parts.insert(&mesh); });
        const auto show = [&](const SkinnedGeometry& mesh)
        {
            const bool isPart = parts.count(&mesh) > 0;
            if (isPart && !isShown(mesh)) return;
            add(mesh, isPart ? madeLevels(mesh, set).get() : nullptr, level, palette);
        };
        if (merged)
            merged->forEachMeshAt(level, meshes, show);
        else
            forEachMesh(meshes, show);
    }

    std::size_t triangleCount() const { return _triangles.size(); }

    /// Of all vertices of triangles of the shown meshes in another pose, or the same. ignored: distances up to it may
    /// count as 0.
    double largestDistance(const std::vector<AffineMatrix>& palette, double ignored = 0.0) const
    {
        double largest = ignored;
        std::size_t first = 0; // the triangle that was near to the last vertex
        forEachMesh(_meshes,
                    [&](const SkinnedGeometry& mesh)
                    {
                        if (!isShown(mesh)) return;
                        std::vector<glm::dvec3> positions;
                        mesh.computePositions(palette, positions);
                        for (const std::uint32_t vertex : verticesOf(mesh))
                            largest = std::max(largest, distanceOf(positions[vertex], largest, first));
                    });
        return largest > ignored ? largest : 0.0;
    }

private:
    struct Triangle
    {
        std::array<glm::dvec3, 3> corners;
        glm::dvec3 centre;
        double radius; ///< of the sphere around the centre
    };

    static bool isShown(const SkinnedGeometry& mesh) { return mesh.getNodeMask() != 0 && !mesh.getDrawCallback(); }

    static std::vector<std::uint32_t> verticesOf(const SkinnedGeometry& mesh)
    {
        std::vector<std::uint32_t> vertices;
        for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : mesh.getPrimitiveSetList())
            for (const std::uint32_t vertex : LodLevels::trianglesOf(primitives, mesh.getVertexCount()))
                vertices.push_back(vertex);
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        return vertices;
    }

    /// levels: null: all triangles.
    void add(const SkinnedGeometry& mesh, const LodLevels* levels, int level, const std::vector<AffineMatrix>& palette)
    {
        std::vector<glm::dvec3> positions, normals;
        mesh.computePositions(palette, positions);
        mesh.computeNormals(palette, normals);
        for (unsigned int i = 0; i < mesh.getNumPrimitiveSets(); ++i)
        {
            const LodLevels::Step reduced = levels ? levels->reduced(i, level) : LodLevels::Step();
            const osg::PrimitiveSet* drawn = reduced.elements ? reduced.elements.get() : mesh.getPrimitiveSet(i);
            const std::vector<std::uint32_t> corners = LodLevels::trianglesOf(drawn, positions.size());
            for (std::size_t corner = 0; corner + 2 < corners.size(); corner += 3)
            {
                Triangle triangle{};
                for (std::size_t number = 0; number < 3; ++number)
                {
                    const std::uint32_t vertex = corners[corner + number];
                    glm::dvec3& place = triangle.corners[number] = positions[vertex];
                    if (reduced.outset > 0.0f && vertex < normals.size() && glm::length(normals[vertex]) > 0.0)
                        place += static_cast<double>(reduced.outset) * glm::normalize(normals[vertex]);
                    triangle.centre += place / 3.0;
                }
                for (const glm::dvec3& place : triangle.corners)
                    triangle.radius = std::max(triangle.radius, glm::distance(place, triangle.centre));
                _triangles.push_back(triangle);
            }
        }
    }

    /// enough: a distance below which the nearest triangle does not matter.
    double distanceOf(const glm::dvec3& point, double enough, std::size_t& inOutFirst) const
    {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < _triangles.size() && nearest > enough; ++i)
        {
            const std::size_t number = (inOutFirst + i) % _triangles.size();
            const Triangle& triangle = _triangles[number];
            const double reach = nearest + triangle.radius;
            const glm::dvec3 way = triangle.centre - point;
            if (glm::dot(way, way) >= reach * reach) continue;
            const double distance = std::sqrt(
                squaredDistanceToTriangle(point, triangle.corners[0], triangle.corners[1], triangle.corners[2]));
            if (distance >= nearest) continue;
            nearest = distance;
            if (nearest <= enough) inOutFirst = number;
        }
        return nearest;
    }

    const osg::Group& _meshes;
    std::vector<Triangle> _triangles;
};

} // namespace osgGpuAnimation
