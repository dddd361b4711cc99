// SPDX-License-Identifier: MIT
#pragma once

#include <osg/BoundingBox>

#include <initializer_list>

namespace osgGpuAnimation
{

/// For osg::TriangleFunctor: the number of triangles and the bounding box of their corners.
struct TriangleBox
{
    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool = false)
    {
        ++triangles;
        for (const osg::Vec3& corner : {a, b, c})
            box.expandBy(corner);
    }
    int triangles = 0;
    osg::BoundingBox box;
};

} // namespace osgGpuAnimation
