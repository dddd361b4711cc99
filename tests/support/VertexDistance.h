// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

#include <algorithm>
#include <cstddef>

namespace osgGpuAnimation
{

/// The largest distance of a vertex of one geometry from the vertex of the same number of the other, in their units;
/// huge if they differ in number. Both have osg::Vec3Arrays.
inline double largestDistance(const osg::Geometry& one, const osg::Geometry& other)
{
    const auto& a = static_cast<const osg::Vec3Array&>(*one.getVertexArray());
    const auto& b = static_cast<const osg::Vec3Array&>(*other.getVertexArray());
    double largest = a.size() == b.size() ? 0.0 : 1e30;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        largest = std::max(largest, static_cast<double>((a[i] - b[i]).length()));
    return largest;
}

} // namespace osgGpuAnimation
