// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/JointTransform.h>

#include <osgGpuAnimation/animation/Rotation.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

glm::vec4 lerp(const glm::vec4& a, const glm::vec4& b, double alpha)
{
    return glm::vec4(glm::dvec4(a) * (1.0 - alpha) + glm::dvec4(b) * alpha);
}

} // namespace

bool JointTransform::isFinite() const
{
    for (const glm::vec4& part : {translation, rotation, scale})
        for (int i = 0; i < 4; ++i)
            if (!std::isfinite(part[i])) return false;
    return true;
}

AffineMatrix JointTransform::toMatrix() const
{
    const glm::dmat3 turn = Rotation::matrix(Rotation::unit(glm::dvec4(rotation)));
    const glm::dvec4 size(scale);
    return AffineMatrix::fromColumns(glm::dmat4(glm::dvec4(turn[0] * size.x, 0.0), glm::dvec4(turn[1] * size.y, 0.0),
                                                glm::dvec4(turn[2] * size.z, 0.0),
                                                glm::dvec4(glm::dvec3(translation), 1.0)));
}

glm::vec4 slerpShortest(const glm::vec4& a, const glm::vec4& b, float alpha)
{
    const glm::dvec4 from = Rotation::unit(glm::dvec4(a));
    // Whatever b is (beyond what can be squared, say), nothing of it is wanted.
    if (alpha == 0.0f) return glm::vec4(from);
    return glm::vec4(Rotation::slerp(from, Rotation::unit(glm::dvec4(b)), static_cast<double>(alpha)));
}

JointTransform interpolate(const JointTransform& a, const JointTransform& b, float alpha)
{
    const double share = static_cast<double>(alpha);
    return {lerp(a.translation, b.translation, share), slerpShortest(a.rotation, b.rotation, alpha),
            lerp(a.scale, b.scale, share)};
}

} // namespace osgGpuAnimation
