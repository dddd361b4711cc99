// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AffineMatrix.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

glm::dvec4 row(const AffineMatrix& matrix, std::size_t index)
{
    return glm::dvec4(matrix.rows[index]);
}

} // namespace

AffineMatrix AffineMatrix::fromColumns(const glm::dmat4& columns)
{
    const glm::dmat4 rows = glm::transpose(columns);
    return {{glm::vec4(rows[0]), glm::vec4(rows[1]), glm::vec4(rows[2])}};
}

glm::dmat4 AffineMatrix::toColumns() const
{
    return glm::transpose(glm::dmat4(row(*this, 0), row(*this, 1), row(*this, 2), glm::dvec4(0.0, 0.0, 0.0, 1.0)));
}

glm::vec3 AffineMatrix::transformPoint(const glm::vec3& point) const
{
    const glm::dvec4 p(glm::dvec3(point), 1.0);
    return glm::vec3(glm::dvec3(glm::dot(row(*this, 0), p), glm::dot(row(*this, 1), p), glm::dot(row(*this, 2), p)));
}

glm::vec3 AffineMatrix::transformVector(const glm::vec3& vector) const
{
    const glm::dvec4 v(glm::dvec3(vector), 0.0);
    return glm::vec3(glm::dvec3(glm::dot(row(*this, 0), v), glm::dot(row(*this, 1), v), glm::dot(row(*this, 2), v)));
}

bool AffineMatrix::isIdentity() const
{
    return rows == AffineMatrix().rows;
}

bool AffineMatrix::isFinite() const
{
    for (const glm::vec4& r : rows)
        for (int c = 0; c < 4; ++c)
            if (!std::isfinite(r[c])) return false;
    return true;
}

AffineMatrix operator*(const AffineMatrix& a, const AffineMatrix& b)
{
    const glm::dvec4 b0 = row(b, 0);
    const glm::dvec4 b1 = row(b, 1);
    const glm::dvec4 b2 = row(b, 2);
    AffineMatrix result;
    for (std::size_t r = 0; r < 3; ++r)
    {
        const glm::dvec4 left = row(a, r);
        result.rows[r] = glm::vec4(left.x * b0 + left.y * b1 + left.z * b2 + glm::dvec4(0.0, 0.0, 0.0, left.w));
    }
    return result;
}

} // namespace osgGpuAnimation
