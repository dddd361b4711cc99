// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/JointTransform.h>

#include <osgGpuAnimation/math/Rotation.h>

#include <glm/mat3x3.hpp>

namespace osgGpuAnimation
{

AffineMatrix JointTransform::toMatrix() const
{
    const glm::dmat3 turn = Rotation::matrix(Rotation::unit(glm::dvec4(rotation)));
    const glm::dvec4 size(scale);
    AffineMatrix matrix;
    for (int row = 0; row < 3; ++row)
        matrix.rows[row] =
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
