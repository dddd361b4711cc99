// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/AlikeVertices.h"
#include "gltf/Meshes.h"

#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// How the vertices of a triangle mesh without normals become a mesh: triangles that were taken apart for a normal of
/// their own are again joined where vertices agree in all the file says of them.
/// Compares what the mesh has read (positions, texture coordinates, colours, targets) and the file's influences,
/// byte by byte.
JoinedVertices joinVertices(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                            const MeshPrimitive& mesh);

/// Normals for programs that do not find the faces' own: those of the triangles round each vertex, by area; +Z where
/// there are none. indices: three a triangle, each below the number of positions.
osg::ref_ptr<osg::Vec3Array> smoothNormals(const osg::Vec3Array& positions, const std::vector<std::uint32_t>& indices);

} // namespace osgGpuAnimation::gltf
