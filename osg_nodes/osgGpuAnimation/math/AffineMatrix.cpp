// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/AffineMatrix.h>

#include <layout.glsl>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace osgGpuAnimation
{

namespace
{

glm::dvec4 row(const AffineMatrix& matrix, std::size_t index)
{
    return glm::dvec4(matrix.rows[index]);
}

glm::vec3 product(const AffineMatrix& matrix, const glm::dvec4& v)
{
    return glm::vec3(glm::dvec3(glm::dot(row(matrix, 0), v), glm::dot(row(matrix, 1), v), glm::dot(row(matrix, 2), v)));
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
    return product(*this, glm::dvec4(glm::dvec3(point), 1.0));
}

glm::vec3 AffineMatrix::transformVector(const glm::vec3& vector) const
{
    return product(*this, glm::dvec4(glm::dvec3(vector), 0.0));
}

bool AffineMatrix::isFinite() const
{
    return areFinite(rows[0]) && areFinite(rows[1]) && areFinite(rows[2]);
}

bool areFinite(const glm::vec4& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

glm::vec4 limited(const glm::dvec4& row)
{
    glm::vec4 result;
    for (int i = 0; i < 4; ++i)
        result[i] = std::isnan(row[i])
                        ? 0.0f
                        : static_cast<float>(std::clamp(row[i], -POSE_LARGEST_NUMBER, POSE_LARGEST_NUMBER));
    return result;
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
        result.rows[r] = limited(left.x * b0 + left.y * b1 + left.z * b2 + glm::dvec4(0.0, 0.0, 0.0, left.w));
    }
    return result;
}

glm::dmat4 limitedProduct(const glm::dmat4& a, const glm::dmat4& b)
{
    glm::dmat4 product = a * b;
    for (int column = 0; column < 4; ++column)
        product[column] = glm::clamp(product[column], -POSE_LARGEST_NUMBER, POSE_LARGEST_NUMBER);
    return product;
}

} // namespace osgGpuAnimation
