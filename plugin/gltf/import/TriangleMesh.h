// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Array>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

// Operations on triangle meshes: corners, normals of meshes that have none, welded vertices, the order of triangles.

/// The corners of all triangles, three per triangle, of a triangle list (mode 4), strip (5) or fan (6) over these
/// vertices; every other triangle of a strip is turned so that all keep one winding (glTF 2.0, section 3.7.2.1).
std::vector<std::uint32_t> triangleCorners(int mode, const std::vector<std::uint32_t>& vertices);

/// The triangle's normal for each vertex, three vertices per triangle: the flat shading that a mesh without normals
/// needs. +Z for a triangle without area.
osg::ref_ptr<osg::Vec3Array> flatNormals(const osg::Vec3Array& positions);

/// For vertices that triangles share: the mean of the triangles' normals, weighted by area; +Z where it is zero.
/// indices: three per triangle, each below the number of positions.
osg::ref_ptr<osg::Vec3Array> smoothNormals(const osg::Vec3Array& positions, const std::vector<std::uint32_t>& indices);

/// One attribute of all vertices of a mesh, packed.
struct VertexStream
{
    const void* data = nullptr;
    std::size_t bytesAVertex = 0;
};

struct WeldedVertices
{
    std::vector<std::uint32_t> vertexOf; ///< by input vertex: its welded vertex, numbered in the order of the input
    std::size_t count = 0;               ///< welded vertices
};

/// Welds the vertices that are equal in all streams, byte by byte. It sorts them: with meshoptimizer's fixed hash a
/// file can make the time grow by the square of the vertices.
WeldedVertices weldVertices(const std::vector<VertexStream>& streams, std::size_t vertexCount);

} // namespace osgGpuAnimation::gltf
