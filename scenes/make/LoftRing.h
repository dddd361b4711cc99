// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace osgGpuAnimation::scenes
{

/// One cross-section of a lofted tube: an ellipse around `center` with the half axes `side` and `front` (metres).
/// Two equal rings after one another make a hard edge, half axes of zero close the end.
struct LoftRing
{
    glm::dvec3 center{0.0};
    glm::dvec3 side{0.0};
    glm::dvec3 front{0.0};
    double back = 1.0;      ///< length of the half axis opposite to `front`, in lengths of `front`
    double roundness = 1.0; ///< 1 an ellipse, towards 0 a rectangle

    /// angle 0 is at the back, a quarter turn later comes `side`, then `front`; radians.
    glm::dvec3 pointAt(double angle) const;
};

/// A ring that lies level at `center`.
LoftRing levelRing(const glm::dvec3& center, double side, double front, double back);
/// A ring across a tube that runs along `direction`; `frontward` says where its front is.
LoftRing ringAcross(const glm::dvec3& center, const glm::dvec3& direction, const glm::dvec3& frontward, double side,
                    double front);
/// The rings of an ellipsoid, from pole to pole, with its poles on `axis` (a half axis, as `side` and `front`).
std::vector<LoftRing> ellipsoid(const glm::dvec3& center, const glm::dvec3& axis, const glm::dvec3& side,
                                const glm::dvec3& front, int rings);

/// A smooth (Catmull-Rom) refinement: `steps` rings for each gap between two given ones. Hard edges stay.
std::vector<LoftRing> refined(const std::vector<LoftRing>& rings, int steps);

} // namespace osgGpuAnimation::scenes
