// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>

namespace osgGpuAnimation
{

/// An affine transform for column vectors: v' = M · (v, 1). Three rows of four floats, row-major: 48 bytes, the very
/// layout of a palette entry in the GPU's buffers. The fourth row is (0, 0, 0, 1) and not stored.
struct AffineMatrix
{
    std::array<glm::vec4, 3> rows{glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0)};

    /// The upper three rows of a column-major GLM matrix; its fourth row is ignored.
    static AffineMatrix fromColumns(const glm::dmat4& columns);
    glm::dmat4 toColumns() const;

    glm::vec3 transformPoint(const glm::vec3& point) const;
    glm::vec3 transformVector(const glm::vec3& vector) const;
    bool isIdentity() const;
    bool isFinite() const;
};

static_assert(sizeof(AffineMatrix) == 48, "a palette entry is 48 bytes on the GPU");

/// a · b: first b, then a.
AffineMatrix operator*(const AffineMatrix& a, const AffineMatrix& b);

} // namespace osgGpuAnimation
