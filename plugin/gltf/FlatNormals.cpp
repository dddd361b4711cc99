// SPDX-License-Identifier: MIT
#include "gltf/FlatNormals.h"

#include <osg/Vec3d>

#include <algorithm>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr int modeTriangles = 4;
constexpr int modeStrip = 5;

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

} // namespace osgGpuAnimation::gltf
