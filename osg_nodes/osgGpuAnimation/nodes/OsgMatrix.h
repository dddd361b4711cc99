// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/JointTransform.h>

#include <glm/gtc/type_ptr.hpp>
#include <osg/Matrixd>

namespace osgGpuAnimation
{

// The kit's matrices are for column vectors, OSG's for row vectors: one is the other's transpose.

/// By columns in memory, which OSG reads by rows.
inline osg::Matrixd toOsg(const glm::dmat4& matrix)
{
    return osg::Matrixd(glm::value_ptr(matrix));
}

inline osg::Matrixd toOsg(const AffineMatrix& matrix)
{
    return toOsg(matrix.toColumns());
}

/// The same in the space in which what it is relative to, the origin, lies.
inline osg::Matrixd toOsg(const AffineMatrix& matrix, const osg::Vec3d& origin)
{
    osg::Matrixd placed = toOsg(matrix);
    placed.setTrans(placed.getTrans() + origin);
    return placed;
}

/// What is affine of it, rounded to float.
inline AffineMatrix toAffine(const osg::Matrixd& matrix)
{
    return AffineMatrix::fromColumns(glm::make_mat4(matrix.ptr()));
}

} // namespace osgGpuAnimation
