// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/JointTransform.h>

#include <glm/gtc/type_ptr.hpp>
#include <osg/Matrixd>

namespace osgGpuAnimation
{

// animation/ multiplies matrices with column vectors, OSG with row vectors: each is the transpose of the other.

/// A matrix in OSG's convention: the columns in memory become OSG's rows.
inline osg::Matrixd toOsg(const glm::dmat4& matrix)
{
    return osg::Matrixd(glm::value_ptr(matrix));
}

/// The same for a 3x4 matrix.
inline osg::Matrixd toOsg(const AffineMatrix& matrix)
{
    return toOsg(matrix.toColumns());
}

/// The same for a matrix whose translation is relative to the origin.
inline osg::Matrixd toOsg(const AffineMatrix& matrix, const osg::Vec3d& origin)
{
    osg::Matrixd placed = toOsg(matrix);
    placed.setTrans(placed.getTrans() + origin);
    return placed;
}

/// The affine part of an OSG matrix, rounded to float.
inline AffineMatrix toAffine(const osg::Matrixd& matrix)
{
    return AffineMatrix::fromColumns(glm::make_mat4(matrix.ptr()));
}

} // namespace osgGpuAnimation
