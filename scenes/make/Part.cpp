// SPDX-License-Identifier: MIT
#include "Part.h"
#include "Atlas.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

/// The four grid vertices around a place, with their shares.
struct GridCell
{
    std::array<int, 4> vertices;
    std::array<double, 4> shares;

    template <typename T>
    T mix(const std::vector<T>& values) const
    {
        T sum = values[vertices[0]] * shares[0];
        for (int corner = 1; corner < 4; ++corner)
            sum += values[vertices[corner]] * shares[corner];
        return sum;
    }
};

GridCell cellAt(const Part& part, double u, double v)
{
    const double across = std::clamp(u, 0.0, 1.0) * (part.columns - 1);
    const int column = std::min(static_cast<int>(across), part.columns - 2);
    const auto above = std::upper_bound(part.along.begin(), part.along.end() - 1, v);
    const int row = std::max(static_cast<int>(above - part.along.begin()) - 1, 0);
    const double height = part.along[row + 1] - part.along[row];
    const double up = height > 0.0 ? std::clamp((v - part.along[row]) / height, 0.0, 1.0) : 0.0;
    const double right = across - column;
    return {{part.vertexAt(row, column), part.vertexAt(row, column + 1), part.vertexAt(row + 1, column),
             part.vertexAt(row + 1, column + 1)},
            {(1.0 - right) * (1.0 - up), right * (1.0 - up), (1.0 - right) * up, right * up}};
}

/// Above zero where the triangles face outwards. Seen from the middle of the part, so that open ends do not matter.
double signedVolume(const Part& part)
{
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& position : part.positions)
        middle += position / static_cast<double>(part.positions.size());
    double volume = 0.0;
    for (const auto& [a, b, c] : part.triangles())
        volume +=
            glm::dot(part.positions[a] - middle, glm::cross(part.positions[b] - middle, part.positions[c] - middle));
    return volume;
}

void placeRows(Part& part)
{
    part.along.assign(1, 0.0);
    for (int row = 1; row < part.rows; ++row)
    {
        double length = 0.0;
        for (int column = 0; column + 1 < part.columns; ++column)
            length += glm::distance(part.positions[part.vertexAt(row, column)],
                                    part.positions[part.vertexAt(row - 1, column)]);
        part.along.push_back(part.along.back() + length);
    }
    for (double& along : part.along)
        along /= part.along.back();
    part.along.back() = 1.0;
}

/// One normal for vertices that coincide: the two ends of a row at the seam, and all of a row at a pole.
void smoothRow(Part& part, int row)
{
    const int first = part.vertexAt(row, 0);
    const int last = part.vertexAt(row, part.columns - 1);
    const bool pole = glm::distance(part.positions[first], part.positions[first + (part.columns - 1) / 2]) < 1e-9;
    glm::dvec3 sum = part.normals[first] + part.normals[last];
    for (int vertex = first + 1; pole && vertex < last; ++vertex)
        sum += part.normals[vertex];
    for (int vertex = first; vertex <= last; ++vertex)
        if (pole || vertex == first || vertex == last) part.normals[vertex] = sum;
}

/// A tube bent to a closed loop: its first and last row coincide.
void smoothLoop(Part& part)
{
    const int last = part.vertexAt(part.rows - 1, 0);
    if (glm::distance(part.positions[0], part.positions[last]) > 1e-9) return;
    if (glm::distance(part.positions[1], part.positions[last + 1]) > 1e-9) return;
    for (int column = 0; column < part.columns; ++column)
        part.normals[column] = part.normals[last + column] = part.normals[column] + part.normals[last + column];
}

void computeNormals(Part& part)
{
    part.normals.assign(part.positions.size(), glm::dvec3(0.0));
    for (const auto& [a, b, c] : part.triangles())
    {
        const glm::dvec3 normal =
            glm::cross(part.positions[b] - part.positions[a], part.positions[c] - part.positions[a]);
        part.normals[a] += normal;
        part.normals[b] += normal;
        part.normals[c] += normal;
    }
    for (int row = 0; row < part.rows; ++row)
        smoothRow(part, row);
    smoothLoop(part);
    for (glm::dvec3& normal : part.normals)
        normal = glm::length(normal) > 0.0 ? glm::normalize(normal) : glm::dvec3(0.0, 1.0, 0.0);
}

} // namespace

glm::dvec2 Part::textureCoordinate(int row, int column) const
{
    const double u = static_cast<double>(column) / (columns - 1);
    return {(rect.x + u * rect.width) / Atlas::size, (rect.y + along[row] * rect.height) / Atlas::size};
}

std::vector<std::array<int, 3>> Part::triangles() const
{
    std::vector<std::array<int, 3>> result;
    const auto add = [&](int a, int b, int c)
    {
        if (glm::length(glm::cross(positions[b] - positions[a], positions[c] - positions[a])) < 1e-12) return;
        result.push_back(clockwise ? std::array{a, c, b} : std::array{a, b, c});
    };
    for (int row = 0; row + 1 < rows; ++row)
        for (int column = 0; column + 1 < columns; ++column)
        {
            const int corner = vertexAt(row, column);
            const int above = vertexAt(row + 1, column);
            add(corner, corner + 1, above + 1);
            add(corner, above + 1, above);
        }
    return result;
}

SurfacePoint Part::surfaceAt(double u, double v) const
{
    return {u, v, cellAt(*this, u, v).mix(positions)};
}

double Part::lightAt(double u, double v) const
{
    return light.empty() ? 1.0 : cellAt(*this, u, v).mix(light);
}

Part loft(const std::vector<LoftRing>& rings, int segments, const Binder& binder)
{
    Part part;
    part.rows = static_cast<int>(rings.size());
    part.columns = segments + 1;
    for (const LoftRing& ring : rings)
        for (int column = 0; column < part.columns; ++column)
        {
            const double turn = static_cast<double>(column % segments) / segments;
            part.positions.push_back(ring.pointAt(turn * glm::two_pi<double>()));
            part.bindings.push_back(binder(part.positions.back(), ring));
        }
    placeRows(part);
    part.clockwise = signedVolume(part) < 0.0;
    computeNormals(part);
    return part;
}

Part mirrored(const Part& part, const Rig& rig)
{
    Part result = part;
    const glm::dvec3 mirror(-1.0, 1.0, 1.0);
    for (glm::dvec3& position : result.positions)
        position *= mirror;
    for (glm::dvec3& normal : result.normals)
        normal *= mirror;
    for (Binding& binding : result.bindings)
        binding = binding.renamed([&](int joint) { return rig.mirrored(joint); });
    result.clockwise = !part.clockwise;
    result.painted = false;
    return result;
}

} // namespace osgGpuAnimation::scenes
