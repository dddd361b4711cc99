// SPDX-License-Identifier: MIT
#include "gltf/import/TriangleMesh.h"

#include <osg/Vec3d>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr int modeTriangles = 4;
constexpr int modeStrip = 5;

const unsigned char* at(const VertexStream& stream, std::size_t vertex)
{
    return static_cast<const unsigned char*>(stream.data) + vertex * stream.bytesAVertex;
}

/// Below, equal to or above 0, as the vertex is in some total order of all.
int compare(const std::vector<VertexStream>& streams, std::uint32_t vertex, std::uint32_t other)
{
    for (const VertexStream& stream : streams)
        if (const int order = std::memcmp(at(stream, vertex), at(stream, other), stream.bytesAVertex)) return order;
    return 0;
}

/// For each vertex the first vertex that equals it.
std::vector<std::uint32_t> firstEqual(const std::vector<VertexStream>& streams, std::size_t vertexCount)
{
    std::vector<std::uint32_t> sorted(vertexCount), first(vertexCount);
    std::iota(sorted.begin(), sorted.end(), 0u);
    std::sort(sorted.begin(), sorted.end(),
              [&](std::uint32_t a, std::uint32_t b)
              {
                  const int order = compare(streams, a, b);
                  return order != 0 ? order < 0 : a < b;
              });
    for (std::size_t i = 0; i < vertexCount; ++i)
        first[sorted[i]] = i > 0 && compare(streams, sorted[i - 1], sorted[i]) == 0 ? first[sorted[i - 1]] : sorted[i];
    return first;
}

} // namespace

std::vector<std::uint32_t> triangleCorners(int mode, const std::vector<std::uint32_t>& vertices)
{
    if (mode == modeTriangles)
    {
        const std::size_t whole = vertices.size() - vertices.size() % 3;
        return std::vector<std::uint32_t>(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(whole));
    }
    std::vector<std::uint32_t> corners;
    if (vertices.size() < 3) return corners;
    corners.reserve(3 * (vertices.size() - 2));
    for (std::size_t i = 0; i + 2 < vertices.size(); ++i)
    {
        if (mode == modeStrip)
            corners.insert(corners.end(), {vertices[i], vertices[i + 1 + i % 2], vertices[i + 2 - i % 2]});
        else
            corners.insert(corners.end(), {vertices[i + 1], vertices[i + 2], vertices[0]});
    }
    return corners;
}

osg::ref_ptr<osg::Vec3Array> flatNormals(const osg::Vec3Array& positions)
{
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    normals->resize(positions.size(), osg::Vec3(0, 0, 1));
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
    {
        const osg::Vec3d first(positions[i]);
        osg::Vec3d normal = (osg::Vec3d(positions[i + 1]) - first) ^ (osg::Vec3d(positions[i + 2]) - first);
        if (normal.normalize() > 0.0)
            std::fill_n(normals->begin() + static_cast<std::ptrdiff_t>(i), 3, osg::Vec3(normal));
    }
    return normals;
}

osg::ref_ptr<osg::Vec3Array> smoothNormals(const osg::Vec3Array& positions, const std::vector<std::uint32_t>& indices)
{
    std::vector<osg::Vec3d> sums(positions.size());
    for (std::size_t corner = 0; corner + 2 < indices.size(); corner += 3)
    {
        const osg::Vec3d first(positions[indices[corner]]);
        const osg::Vec3d area =
            (osg::Vec3d(positions[indices[corner + 1]]) - first) ^ (osg::Vec3d(positions[indices[corner + 2]]) - first);
        for (std::size_t i = corner; i < corner + 3; ++i)
            sums[indices[i]] += area;
    }
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    normals->reserve(sums.size());
    for (osg::Vec3d& sum : sums)
        normals->push_back(sum.normalize() > 0.0 ? osg::Vec3(sum) : osg::Vec3(0, 0, 1));
    return normals;
}

WeldedVertices weldVertices(const std::vector<VertexStream>& streams, std::size_t vertexCount)
{
    WeldedVertices welded{firstEqual(streams, vertexCount), 0};
    for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
    {
        const std::uint32_t first = welded.vertexOf[vertex];
        welded.vertexOf[vertex] = first == vertex ? static_cast<std::uint32_t>(welded.count++) : welded.vertexOf[first];
    }
    return welded;
}

} // namespace osgGpuAnimation::gltf
