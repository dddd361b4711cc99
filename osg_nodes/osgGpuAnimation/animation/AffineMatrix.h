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
    std::array<glm::vec4, 3> rows{glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0)};

    /// Converts a column-major GLM matrix; its fourth row is ignored.
    static AffineMatrix fromColumns(const glm::dmat4& columns);
    /// The column-major GLM matrix.
    glm::dmat4 toColumns() const;

    /// M · (point, 1).
    glm::vec3 transformPoint(const glm::vec3& point) const;
    /// M · (vector, 0): without the translation.
    glm::vec3 transformVector(const glm::vec3& vector) const;
    bool isIdentity() const; ///< exactly
    bool isFinite() const;   ///< true if all twelve numbers are finite
};

static_assert(sizeof(AffineMatrix) == 48, "a palette entry is 48 bytes on the GPU");

/// a · b: applies b first, then a. Computes in double precision and rounds once.
AffineMatrix operator*(const AffineMatrix& a, const AffineMatrix& b);

} // namespace osgGpuAnimation
