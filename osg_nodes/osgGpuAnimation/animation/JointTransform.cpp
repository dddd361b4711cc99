// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/JointTransform.h>

#include <layout.glsl>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

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

bool areFinite(const glm::vec4& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
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

bool AffineMatrix::isIdentity() const
{
    return rows == AffineMatrix().rows;
}

bool AffineMatrix::isFinite() const
{
    return areFinite(rows[0]) && areFinite(rows[1]) && areFinite(rows[2]);
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

namespace Rotation
{

glm::dvec4 unit(const glm::dvec4& q)
{
    const double squared = glm::dot(q, q);
    if (!(squared > 0.0) || !std::isfinite(squared)) return glm::dvec4(0.0, 0.0, 0.0, 1.0);
    return q / std::sqrt(squared);
}

glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double alpha)
{
    const glm::dvec4 from = unit(a);
    // At alpha 0 the result does not depend on b, which may be too large to be squared.
    return alpha == 0.0 ? from : numbers(glm::slerp(quaternion(from), quaternion(unit(b)), alpha));
}

} // namespace Rotation

AffineMatrix JointTransform::toMatrix() const
{
    const glm::dmat3 turn = Rotation::matrix(Rotation::unit(glm::dvec4(rotation)));
    const glm::dvec4 size(scale);
    AffineMatrix matrix;
    for (int row = 0; row < 3; ++row)
        matrix.rows[static_cast<std::size_t>(row)] =
            limited({turn[0][row] * size.x, turn[1][row] * size.y, turn[2][row] * size.z, translation[row]});
    return matrix;
}

bool JointTransform::isFinite() const
{
    return areFinite(translation) && areFinite(rotation) && areFinite(scale);
}

float& JointTransform::number(std::size_t index)
{
    const auto place = static_cast<glm::vec4::length_type>(index % 4);
    if (index < 4) return translation[place];
    return index < 8 ? rotation[place] : scale[place];
}

} // namespace osgGpuAnimation
