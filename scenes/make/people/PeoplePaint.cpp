// SPDX-License-Identifier: MIT
#include "PeoplePaint.h"
#include "../Brush.h"
#include "../Noise.h"
#include "../wanderer/WandererPaint.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes::peoplePaint
{

namespace
{

using glm::dvec3;

const dvec3 wool(0.92, 0.90, 0.86);
const dvec3 light(1.0, 0.99, 0.95);
const dvec3 seamed = wool * 0.66;
const dvec3 lined(0.36, 0.32, 0.30);
const dvec3 skinned(0.99, 0.84, 0.71);

/// Seams and stitches of a trunk that buttons in front.
dvec3 buttoned(dvec3 colour, const SurfacePoint& point)
{
    const dvec3& p = point.position;
    if (p.z <= 0.0) return brush::over(colour, seamed, brush::line(p.x, 0.0024));
    colour = brush::over(colour, seamed * 0.9, brush::line(p.x, 0.0030));
    return brush::over(colour, light, 0.8 * brush::stitches(p.x - 0.050, p.y));
}

dvec3 pocket(dvec3 colour, double x, double y)
{
    const double patch = brush::roundedBox(x, y, 0.046, 0.048, 0.014);
    const double flap = brush::roundedBox(x, y - 0.033, 0.050, 0.018, 0.010);
    colour = brush::over(colour, seamed, brush::inside(patch - 0.0035));
    colour = brush::over(colour, wool * 0.96, brush::inside(patch));
    colour = brush::over(colour, light, 0.8 * brush::stitches(patch + 0.007, x + y));
    colour = brush::over(colour, seamed, brush::inside(flap - 0.0035));
    return brush::over(colour, wool * 0.88, brush::inside(flap));
}

/// Yarn that runs across the part.
dvec3 knitted(const SurfacePoint& point, double ribs)
{
    const double rib = std::sin(point.v * glm::two_pi<double>() * ribs + 3.0 * std::sin(point.u * 6.283));
    return brush::cloth(wool * (1.0 + 0.08 * rib), point.position);
}

} // namespace

Painter coat(double hem)
{
    return [hem](const SurfacePoint& point)
    {
        const dvec3& p = point.position;
        if (point.v > hem + 0.012) return brush::cloth(lined, p);
        dvec3 colour = wool * (0.94 + 0.06 * glm::smoothstep(0.6, 0.95, p.y));
        const double above = p.y - 0.648;
        colour = brush::over(colour, seamed * 0.8, brush::line(above, 0.012));
        colour = brush::over(colour, light, brush::line(above, 0.0035));
        if (p.z > 0.0) colour = pocket(colour, std::abs(p.x) - 0.118, p.y - 0.745);
        return brush::cloth(buttoned(colour, point), p);
    };
}

Painter jacket(double hem)
{
    return [hem](const SurfacePoint& point)
    {
        const dvec3& p = point.position;
        if (point.v > hem + 0.02) return brush::cloth(lined, p);
        if (p.y < 0.738) // a ribbed hem
            return brush::cloth(seamed * (1.05 + 0.12 * std::sin(point.u * glm::two_pi<double>() * 60.0)), p);
        dvec3 colour = wool;
        for (int seam = 0; seam < 5; ++seam) // quilted
        {
            const double off = p.y - 0.800 - 0.085 * seam;
            const double puff = 1.0 - glm::smoothstep(0.0, 0.016, std::abs(off));
            colour *= 1.0 - 0.16 * puff;
            colour = brush::over(colour, seamed, brush::line(off, 0.0022));
        }
        if (p.z > 0.0)
        {
            colour = brush::over(colour, seamed,
                                 std::abs(p.x) < 0.045 ? 1.0 - brush::inside(0.045 - 0.003 - std::abs(p.x)) : 0.0);
            for (double height : {1.120, 1.035, 0.950, 0.865}) // the toggles' cords
                colour = brush::over(colour, lined, std::abs(p.x) < 0.058 ? brush::line(p.y - height, 0.0045) : 0.0);
        }
        return brush::cloth(buttoned(colour, point), p);
    };
}

Painter robe(double hem)
{
    return [hem](const SurfacePoint& point)
    {
        const dvec3& p = point.position;
        if (point.v > hem + 0.010) return brush::cloth(lined, p);
        dvec3 colour = wool * (0.90 + 0.10 * glm::smoothstep(0.4, 0.95, p.y));
        const double above = p.y - 0.448;
        colour = brush::over(colour, seamed * 0.75, brush::inside(std::abs(above) - 0.024));
        for (double edge : {-0.018, 0.018})
            colour = brush::over(colour, light, brush::line(above - edge, 0.003));
        const double place = point.u * 26.0; // a row of lozenges
        const double across = (place - std::floor(place) - 0.5) * 0.050;
        colour = brush::over(colour, light, brush::inside(std::abs(across) + 1.3 * std::abs(above) - 0.012));
        // The right side laps over the left one.
        const double lap = p.x + 0.055 - 0.42 * std::max(0.0, p.y - 0.93);
        if (p.z > 0.0)
        {
            colour = brush::over(colour, seamed * 0.75, brush::inside(std::abs(lap) - 0.011));
            colour = brush::over(colour, light, brush::line(lap, 0.0028));
        }
        return brush::cloth(colour, p);
    };
}

Painter hat(double brim)
{
    return [brim](const SurfacePoint& point)
    {
        const dvec3& p = point.position;
        dvec3 colour = wool * (0.97 + 0.05 * noise(p * 30.0));
        if (point.v < brim * 0.5) colour *= 0.80;
        const double band = point.v - brim - 0.05;
        colour = brush::over(colour, lined * 1.25, brush::inside(std::abs(band) - 0.050, 0.004));
        return brush::cloth(colour, p);
    };
}

Painter cap(double fold)
{
    return [fold](const SurfacePoint& point)
    {
        const dvec3& p = point.position;
        const bool folded = point.v < fold;
        const double rib = std::sin(point.u * glm::two_pi<double>() * (folded ? 44.0 : 30.0));
        dvec3 colour = (folded ? seamed * 1.12 : wool) * (1.0 + 0.08 * rib);
        if (!folded)
            for (double stripe : {0.12, 0.22})
                colour = brush::over(colour, light, brush::inside(std::abs(point.v - fold - stripe) - 0.018, 0.004));
        return brush::cloth(colour, p);
    };
}

// Metres from the shoulder to the point, along the arm at rest.
double alongArm(const dvec3& point)
{
    const dvec3 shoulder(0.150, 1.130, -0.010);
    return glm::dot(point - shoulder, glm::normalize(dvec3(0.301, -0.301, 0.0)));
}

dvec3 sleeve(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    if (point.v > 0.86) return brush::cloth(lined, p);
    const double along = alongArm(p);
    dvec3 colour = wool;
    colour = brush::over(colour, seamed * 0.8, brush::inside(0.386 - along));
    colour = brush::over(colour, light, brush::line(along - 0.415, 0.0035));
    return brush::cloth(colour, p);
}

dvec3 jacketSleeve(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    if (point.v > 0.86) return brush::cloth(lined, p);
    const double along = alongArm(p);
    if (along > 0.386)
        return brush::cloth(seamed * (1.05 + 0.12 * std::sin(point.u * glm::two_pi<double>() * 26.0)), p);
    dvec3 colour = wool;
    for (double seam : {0.06, 0.145, 0.23, 0.315})
    {
        colour *= 1.0 - 0.16 * (1.0 - glm::smoothstep(0.0, 0.016, std::abs(along - seam)));
        colour = brush::over(colour, seamed, brush::line(along - seam, 0.0022));
    }
    return brush::cloth(colour, p);
}

dvec3 robeSleeve(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    if (point.v > 0.86) return brush::cloth(lined, p);
    const double along = alongArm(p);
    dvec3 colour = brush::over(wool, seamed * 0.75, brush::inside(0.386 - along));
    for (double edge : {0.394, 0.436})
        colour = brush::over(colour, light, brush::line(along - edge, 0.003));
    return brush::cloth(colour, p);
}

dvec3 collar(const SurfacePoint& point)
{
    return brush::cloth(point.v > 0.6 ? lined : wool * 0.86, point.position);
}

dvec3 sash(const SurfacePoint& point)
{
    const double fold = std::sin(point.v * glm::two_pi<double>() * 4.0 + 2.0 * std::sin(point.u * 12.566));
    return brush::cloth(wool * (0.93 + 0.07 * fold), point.position);
}

dvec3 hood(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    if (point.v < 0.30) return brush::cloth(lined, p);
    if (p.z > 0.100) // the rim
        return brush::cloth(light * (0.93 + 0.07 * std::sin(point.u * glm::two_pi<double>() * 60.0)), p);
    const double seam = (point.u - 0.5) * 1.4;
    dvec3 colour = brush::over(wool, seamed, brush::line(seam, 0.0028));
    colour = brush::over(colour, light, 0.8 * brush::stitches(std::abs(seam) - 0.011, p.z - 0.6 * p.y));
    return brush::cloth(colour, p);
}

dvec3 scarf(const SurfacePoint& point)
{
    return knitted(point, 38.0);
}

dvec3 scarfTail(const SurfacePoint& point)
{
    const double rib = std::sin(point.u * glm::two_pi<double>() * 16.0);
    dvec3 colour = wool;
    for (double band : {0.64, 0.72, 0.80})
        colour = brush::over(colour, seamed * 0.8, brush::line((point.v - band) * 0.5, 0.011));
    if (point.v > 0.87) colour = light * (0.84 + 0.14 * (std::sin(point.u * glm::two_pi<double>() * 20.0) > 0.0));
    return brush::cloth(colour * (1.0 + 0.06 * rib), point.position);
}

dvec3 trousers(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    dvec3 colour = wool;
    colour = brush::over(colour, seamed, brush::line(p.x - 0.172, 0.010));
    if (p.z > 0.0)
    {
        const double patch = brush::roundedBox(p.x - 0.102, p.y - 0.415, 0.043, 0.050, 0.016);
        colour = brush::over(colour, wool * 0.84, brush::inside(patch));
        colour = brush::over(colour, light, 0.8 * brush::stitches(patch + 0.007, p.x + p.y));
    }
    return brush::cloth(colour, p);
}

dvec3 glove(const SurfacePoint& point)
{
    return brush::hide(wool, point.position);
}

dvec3 boot(const SurfacePoint& point)
{
    return wandererPaint::boot(point);
}

dvec3 sole(const SurfacePoint& point)
{
    return wandererPaint::sole(point);
}

dvec3 pack(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    const bool flap = p.y > 1.0365;
    dvec3 colour = flap ? wool * 0.84 : wool;
    colour = brush::over(colour, light, 0.8 * brush::stitches(p.y - (flap ? 1.050 : 0.925), point.u * 0.6));
    if (p.z < -0.2)
        for (double x : {-0.062, 0.062})
        {
            colour = brush::over(colour, lined, brush::inside(std::abs(p.x - x) - 0.013));
            const double plate = brush::roundedBox(p.x - x, p.y - 1.000, 0.019, 0.016, 0.004);
            colour = brush::over(colour, dvec3(0.80, 0.66, 0.36), brush::inside(plate));
            colour = brush::over(colour, lined, brush::inside(plate + 0.008));
        }
    return brush::cloth(colour, p);
}

dvec3 blanket(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    dvec3 colour = wool;
    const double off = std::abs(p.x) - 0.074; // the leather that ties it
    for (double stripe : {0.025, 0.040, 0.115, 0.130})
        colour = brush::over(colour, seamed * 0.85, brush::inside(std::abs(std::abs(p.x) - stripe) - 0.004));
    colour = brush::over(colour, lined * 0.8, brush::inside(std::abs(off) - 0.010));
    if (std::abs(p.x) > 0.164) // a spiral of layers
    {
        const double radius = std::hypot(p.y - 1.172, p.z + 0.196);
        const double turn = std::atan2(p.y - 1.172, p.z + 0.196) / glm::two_pi<double>();
        colour = wool * (0.72 + 0.22 * std::sin((radius / 0.014 + turn) * glm::two_pi<double>()));
    }
    return brush::cloth(colour, p);
}

dvec3 hair(const SurfacePoint& point)
{
    const double streak =
        0.5 + 0.5 * std::sin(point.u * glm::two_pi<double>() * 9.0 + 1.5 * noise(point.position * 25.0));
    return wool * (0.80 + 0.16 * streak) * (0.92 + 0.12 * point.v);
}

dvec3 skin(const SurfacePoint&)
{
    return skinned * dvec3(0.985, 0.95, 0.93);
}

} // namespace osgGpuAnimation::scenes::peoplePaint
