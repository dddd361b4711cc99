// SPDX-License-Identifier: MIT
#include "SerpentScales.h"
#include "../PngEncoder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

constexpr int side = 128;  ///< pixels
constexpr int across = 2;  ///< scales in a row of the map
constexpr int rows = 4;    ///< each half a scale aside from its neighbours
constexpr int around = 7;  ///< repeats of the map
constexpr int along = 26;  ///< the same, on the body
constexpr double bump = 7; ///< pixels: a scale's height

/// The height of the uppermost scale there, [0, 1]. x, y: pixels; y grows towards the tips.
double heightAt(double x, double y)
{
    constexpr double width = static_cast<double>(side) / across, length = static_cast<double>(side) / rows;
    constexpr double reach = 0.72 * width; // the radius of a scale's round end
    double height = 0.0;
    // A scale lies over those of the rows after its own: the first one that reaches here is seen.
    const int last = static_cast<int>(std::floor(y / length)) + 1;
    for (int row = last - 4; row <= last; ++row)
    {
        const double shift = row % 2 == 0 ? 0.0 : 0.5;
        const double dx = x - (std::round(x / width - shift) + shift) * width;
        const double dy = y - (row * length - 0.5 * length);
        const double inside = 1.0 - std::hypot(dx, std::max(0.0, dy)) / reach;
        if (inside <= 0.0) continue;
        const double tilt = glm::clamp(0.5 + 0.5 * dy / reach, 0.0, 1.0);
        height = glm::smoothstep(0.0, 0.28, inside) * (0.45 + 0.55 * tilt) - 0.25 * std::abs(dx) / width;
        break;
    }
    return height;
}

/// The mean of nine samples.
double smoothHeightAt(double x, double y)
{
    double sum = 0.0;
    for (const double dy : {-0.7, 0.0, 0.7})
        for (const double dx : {-0.7, 0.0, 0.7})
            sum += heightAt(x + dx, y + dy);
    return sum / 9.0;
}

} // namespace

std::vector<std::uint8_t> scaleNormals()
{
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
        {
            const double right = x + 0.5, down = y + 0.5;
            const double slopeRight = smoothHeightAt(right + 1.0, down) - smoothHeightAt(right - 1.0, down);
            const double slopeDown = smoothHeightAt(right, down + 1.0) - smoothHeightAt(right, down - 1.0);
            // Green is up in the picture (glTF 2.0, section 3.9.3).
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.5 * bump * slopeRight, 0.5 * bump * slopeDown, 1.0));
            for (int axis = 0; axis < 3; ++axis)
                pixels.push_back(static_cast<std::uint8_t>(std::lround((normal[axis] * 0.5 + 0.5) * 255.0)));
        }
    return encodePng(pixels, side, side);
}

void appendScales(PrimitiveArrays& arrays, const Part& part)
{
    for (int row = 0; row < part.rows; ++row)
        for (int column = 0; column < part.columns; ++column)
        {
            const double u = static_cast<double>(column) / (part.columns - 1);
            arrays.textureCoordinates.emplace_back(around * u, along * part.along[row]);
            // The first and the last column are one place.
            const int before = column == 0 ? part.columns - 2 : column - 1;
            const int after = column == part.columns - 1 ? 1 : column + 1;
            const glm::dvec3& normal = part.normals[part.vertexAt(row, column)];
            glm::dvec3 tangent = part.positions[part.vertexAt(row, after)] - part.positions[part.vertexAt(row, before)];
            if (glm::length(tangent) < 1e-9) tangent = {1.0, 0.0, 0.0}; // a pole
            tangent = glm::normalize(tangent - normal * glm::dot(normal, tangent));
            const int next = std::min(row + 1, part.rows - 1), previous = std::max(row - 1, 0);
            const glm::dvec3 downwards =
                part.positions[part.vertexAt(next, column)] - part.positions[part.vertexAt(previous, column)];
            const double hand = glm::dot(glm::cross(normal, tangent), downwards) < 0.0 ? 1.0 : -1.0;
            arrays.tangents.emplace_back(tangent, hand);
        }
}

} // namespace osgGpuAnimation::scenes
