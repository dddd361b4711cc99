// SPDX-License-Identifier: MIT
#include "gltf/import/TriangleMesh.h"

#include <osg/Vec3d>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <random>

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

/// A hash of each vertex: the sum of its words, each times a random factor of its place. An attacker who does not know
/// the factors cannot construct vertices with equal sums.
std::vector<std::uint64_t> hashes(const std::vector<VertexStream>& streams, std::size_t vertexCount)
{
    std::random_device device;
    std::seed_seq seed{device(), device(), device(), device()};
    std::mt19937_64 random(seed);
    std::vector<std::uint64_t> sums(vertexCount);
    for (const VertexStream& stream : streams)
    {
        assert(stream.bytesAVertex % 4 == 0 && "vertices are made of words");
        for (std::size_t place = 0; place < stream.bytesAVertex; place += 4)
        {
            const std::uint64_t factor = random() | 1;
            for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
            {
                std::uint32_t word;
                std::memcpy(&word, at(stream, vertex) + place, sizeof(word));
                sums[vertex] += factor * word;
            }
        }
    }
    return sums;
}

bool areEqual(const std::vector<VertexStream>& streams, std::size_t a, std::size_t b)
{
    return std::all_of(streams.begin(), streams.end(),
                       [=](const VertexStream& stream)
                       { return std::memcmp(at(stream, a), at(stream, b), stream.bytesAVertex) == 0; });
}

/// For each vertex the first vertex that equals it.
std::vector<std::uint32_t> firstEqual(const std::vector<VertexStream>& streams, std::size_t vertexCount)
{
    const std::vector<std::uint64_t> sums = hashes(streams, vertexCount);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted(vertexCount);
    for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
        sorted[vertex] = {sums[vertex], static_cast<std::uint32_t>(vertex)};
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> first(vertexCount);
    std::vector<std::uint32_t> different; // vertices of one hash: nearly always a single one
    for (std::size_t i = 0; i < vertexCount; ++i)
    {
        const std::uint32_t vertex = sorted[i].second;
        if (i == 0 || sorted[i].first != sorted[i - 1].first) different.clear();
        const auto equal = std::find_if(different.begin(), different.end(),
                                        [&](std::uint32_t other) { return areEqual(streams, vertex, other); });
        first[vertex] = equal != different.end() ? *equal : vertex;
        if (equal == different.end()) different.push_back(vertex);
    }
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
