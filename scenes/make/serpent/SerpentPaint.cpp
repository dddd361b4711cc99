// SPDX-License-Identifier: MIT
#include "SerpentPaint.h"
#include "../Noise.h"
#include "SerpentRig.h"

#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes::serpentPaint
{

namespace
{

using glm::dvec3;

const dvec3 deepSea(0.07, 0.34, 0.47);
const dvec3 lagoon(0.14, 0.62, 0.62);
const dvec3 sand(0.98, 0.88, 0.66);
const dvec3 coral(0.97, 0.42, 0.30);
const dvec3 amber(1.00, 0.72, 0.25);

} // namespace

dvec3 scales(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    const double height = -std::cos(point.u * glm::two_pi<double>()); // 1 on the back, -1 below
    const double band = glm::smoothstep(0.35, 0.65, 0.5 + 0.5 * std::sin(p.z * 21.0 + 1.2 * noise(p * 6.0)));
    dvec3 colour = glm::mix(lagoon, deepSea, glm::smoothstep(-0.1, 0.95, height) * (0.35 + 0.65 * band));
    colour *= 1.0 + 0.10 * noise(p * 45.0);
    const double belly = 1.0 - glm::smoothstep(-0.62, -0.30, height);
    colour = glm::mix(colour, sand * (0.92 + 0.08 * std::sin(p.z * 95.0)), belly);
    const double stripe = 1.0 - glm::smoothstep(0.10, 0.24, std::abs(height + 0.22));
    return glm::mix(colour, amber, 0.75 * stripe * glm::smoothstep(-0.02, 0.10, serpentNeck - p.z));
}

dvec3 jaw(const SurfacePoint& point)
{
    const double height = -std::cos(point.u * glm::two_pi<double>());
    return height > 0.3 ? coral * 0.75 : sand;
}

dvec3 eye(const SurfacePoint& point)
{
    if (point.v > 0.84) return dvec3(0.05, 0.04, 0.06);
    return point.v > 0.66 ? amber : dvec3(0.96, 0.95, 0.88);
}

dvec3 fin(const SurfacePoint& point)
{
    const double edge = 0.5 - 0.5 * std::cos(point.u * glm::two_pi<double>());
    const double rays = 0.92 + 0.08 * std::cos(point.v * 150.0);
    return glm::mix(coral, amber, edge) * rays;
}

} // namespace osgGpuAnimation::scenes::serpentPaint
