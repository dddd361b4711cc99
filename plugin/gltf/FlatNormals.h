// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Array>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The corners of all triangles, three a triangle, of a triangle list (mode 4), strip (5) or fan (6) over these
/// vertices; in strips every other triangle is turned so that all keep one winding (glTF 2.0, section 3.7.2.1).
std::vector<std::uint32_t> triangleCorners(int mode, const std::vector<std::uint32_t>& vertices);

/// For vertices that belong to one triangle each, three after three: the triangle's own normal, as a mesh without
/// normals is to be shaded. A triangle without area takes +Z.
osg::ref_ptr<osg::Vec3Array> flatNormals(const osg::Vec3Array& positions);

} // namespace osgGpuAnimation::gltf
