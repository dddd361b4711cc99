// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>

namespace osgGpuAnimation
{

/// An affine transform for column vectors: v' = M · (v, 1). It stores three rows of four floats, row-major: 48 bytes,
/// the layout of a palette entry on the GPU. The fourth row is always (0, 0, 0, 1). Default: the identity.
struct AffineMatrix
{
    /// the first three rows of the matrix
    std::array<glm::vec4, 3> rows{glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0)};

    /// Converts a column-major GLM matrix; its fourth row is ignored.
    static AffineMatrix fromColumns(const glm::dmat4& columns);
    /// The column-major GLM matrix.
    glm::dmat4 toColumns() const;

    /// M · (point, 1).
    glm::vec3 transformPoint(const glm::vec3& point) const;
    /// M · (vector, 0): without the translation.
    glm::vec3 transformVector(const glm::vec3& vector) const;
    bool operator==(const AffineMatrix& other) const { return rows == other.rows; } ///< exactly
    bool isIdentity() const { return *this == AffineMatrix(); }                     ///< exactly
    bool isFinite() const; ///< true if all twelve numbers are finite
};

static_assert(sizeof(AffineMatrix) == 48, "a palette entry is 48 bytes on the GPU");

/// True if all four numbers are finite.
bool areFinite(const glm::vec4& v);

/// A row of a matrix as the shaders take it: numbers beyond ±1e18 are limited (POSE_LARGEST_NUMBER), and those that are
/// no number become 0, so that chains stay finite.
glm::vec4 limited(const glm::dvec4& row);

/// a · b: applies b first, then a. Computes in double precision, rounds once, and limits the rows.
AffineMatrix operator*(const AffineMatrix& a, const AffineMatrix& b);

/// The same in double precision, without rounding. Both are finite.
glm::dmat4 limitedProduct(const glm::dmat4& a, const glm::dmat4& b);

} // namespace osgGpuAnimation
