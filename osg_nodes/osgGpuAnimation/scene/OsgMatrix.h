// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/animation/RootMotion.h>
#include <osgGpuAnimation/math/JointTransform.h>
#include <osgGpuAnimation/math/Result.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <osg/BoundingBox>
#include <osg/Matrixd>

#include <string>
#include <vector>

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

/// Of the linear part: 0 flattens, below 0 mirrors.
inline double determinantOf(const osg::Matrixd& matrix)
{
    return glm::determinant(glm::dmat3(glm::make_mat4(matrix.ptr())));
}

/// The affine part of an OSG matrix, rounded to float.
inline AffineMatrix toAffine(const osg::Matrixd& matrix)
{
    return AffineMatrix::fromColumns(glm::make_mat4(matrix.ptr()));
}

/// The same for a matrix that draws vertices. name: the matrix, for messages. Errors: the matrix is not finite, not
/// affine or mirrors; isInvertible: it flattens.
inline Result<AffineMatrix> toRootMatrix(const osg::Matrixd& matrix, const std::string& name, bool isInvertible)
{
    const AffineMatrix root = toAffine(matrix);
    if (!root.isFinite()) return Error{name + " is not finite"};
    if (matrix(0, 3) != 0.0 || matrix(1, 3) != 0.0 || matrix(2, 3) != 0.0 || matrix(3, 3) != 1.0)
        return Error{name + " is not affine: its last column is not 0, 0, 0, 1"};
    const double determinant = determinantOf(matrix);
    if (determinant < 0.0) return Error{name + " mirrors: its determinant is below 0, faces would be seen from inside"};
    if (isInvertible && determinant == 0.0) return Error{name + " flattens: its determinant is 0"};
    return root;
}

/// The root motion in a node's space. fileToNode: from the space of the motion to the node's.
inline osg::Matrixd toOsg(const RootMotion& motion, const osg::Matrixd& fileToNode)
{
    if (motion.isNone()) return {};
    return osg::Matrixd::inverse(fileToNode) * toOsg(motion.matrix()) * fileToNode;
}

/// Poses all joints in a layer, see JointPose::setModelTransforms(). jointToNode: one per joint, from the joint's space
/// to a node's. fileToNode: from the file's axes to the node's. Errors, without a change: those of
/// setModelTransforms(); a matrix is not affine.
inline Result<void> poseJoints(AnimationController& controller, std::size_t layer,
                               const std::vector<osg::Matrixd>& jointToNode, const osg::Matrixd& fileToNode)
{
    const osg::Matrixd nodeToFile = osg::Matrixd::inverse(fileToNode);
    std::vector<AffineMatrix> jointToFile;
    for (const osg::Matrixd& matrix : jointToNode)
    {
        if (matrix(0, 3) != 0.0 || matrix(1, 3) != 0.0 || matrix(2, 3) != 0.0 || matrix(3, 3) != 1.0)
            return Error{"the matrix of joint " + std::to_string(jointToFile.size()) +
                         " is not affine: its last column is not 0, 0, 0, 1"};
        jointToFile.push_back(toAffine(matrix * nodeToFile));
    }
    return controller.layer(layer).pose().setModelTransforms(jointToFile);
}

/// The rotation of a matrix without its translation, scale and mirroring, from its rows, which are OSG's axes: +Z keeps
/// its direction, +Y its plane with +Z. The identity if the matrix flattens +Y or +Z.
inline osg::Matrixd rotationOf(const osg::Matrixd& matrix)
{
    osg::Vec3d z(matrix(2, 0), matrix(2, 1), matrix(2, 2)), y(matrix(1, 0), matrix(1, 1), matrix(1, 2));
    if (!(z.normalize() > 0.0) || !(y.normalize() > 0.0)) return {};
    y -= z * (y * z);
    if (!(y.normalize() > 0.0)) return {};
    const osg::Vec3d x = y ^ z;
    return osg::Matrixd(x.x(), x.y(), x.z(), 0, y.x(), y.y(), y.z(), 0, z.x(), z.y(), z.z(), 0, 0, 0, 0, 1);
}

/// The smallest box around the eight corners of the transformed box; exact for quarter turns.
inline osg::BoundingBox transformed(const osg::BoundingBox& box, const osg::Matrixd& matrix)
{
    osg::BoundingBox result;
    for (unsigned int corner = 0; corner < 8 && box.valid(); ++corner)
        result.expandBy(box.corner(corner) * matrix);
    return result;
}

} // namespace osgGpuAnimation
