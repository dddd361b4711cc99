// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/JointTransform.h>

#include <osgGpuAnimation/animation/Rotation.h>

#include <cmath>

namespace osgGpuAnimation
{

AffineMatrix JointTransform::toMatrix() const
{
    const glm::dmat3 turn = Rotation::matrix(Rotation::unit(glm::dvec4(rotation)));
    const glm::dvec4 size(scale);
    return AffineMatrix::fromColumns(glm::dmat4(glm::dvec4(turn[0] * size.x, 0.0), glm::dvec4(turn[1] * size.y, 0.0),
                                                glm::dvec4(turn[2] * size.z, 0.0),
                                                glm::dvec4(glm::dvec3(translation), 1.0)));
}

bool JointTransform::isFinite() const
{
    for (const glm::vec4& part : {translation, rotation, scale})
        for (int i = 0; i < 4; ++i)
            if (!std::isfinite(part[i])) return false;
    return true;
}

float& JointTransform::number(std::size_t index)
{
    const auto place = static_cast<glm::vec4::length_type>(index % 4);
    if (index < 4) return translation[place];
    return index < 8 ? rotation[place] : scale[place];
}

} // namespace osgGpuAnimation
