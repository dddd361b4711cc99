// SPDX-License-Identifier: MIT
#include "WandererPaint.h"
#include "../Brush.h"
#include "../Noise.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes::wandererPaint
{

namespace
{

using glm::dvec3;

const dvec3 mustard(0.91, 0.66, 0.24);
const dvec3 ochre(0.80, 0.51, 0.17);
const dvec3 cream(0.97, 0.91, 0.78);
const dvec3 teal(0.13, 0.53, 0.54);
const dvec3 indigo(0.29, 0.34, 0.50);
const dvec3 skin(0.99, 0.84, 0.71);
const dvec3 leatherBrown(0.52, 0.31, 0.19);
const dvec3 darkBrown(0.29, 0.17, 0.13);
const dvec3 brassYellow(0.93, 0.76, 0.38);
const dvec3 ginger(0.70, 0.33, 0.15);

/// A patch pocket around (0.125, 0.735) and its twin, with a flap.
dvec3 pockets(const dvec3& below, const dvec3& position)
{
    const double x = std::abs(position.x) - 0.118;
    const double y = position.y - 0.735;
    const double patch = brush::roundedBox(x, y, 0.046, 0.048, 0.014);
    const double flap = brush::roundedBox(x, y - 0.033, 0.050, 0.018, 0.010);
    dvec3 colour = brush::over(below, ochre * 0.62, brush::inside(patch - 0.0035));
    colour = brush::over(colour, mustard * 0.97, brush::inside(patch));
    colour = brush::over(colour, cream, 0.8 * brush::stitches(patch + 0.007, x + y));
    colour = brush::over(colour, ochre * 0.62, brush::inside(flap - 0.0035));
    return brush::over(colour, ochre, brush::inside(flap));
}

dvec3 mouth(const dvec3& below, double x, double y)
{
    const double wide = 0.034;
    const double bow = 1.0 - x * x / (wide * wide);
    const double upper = y + 0.078 - 0.007 * (1.0 - bow); // the line of the lips, its ends drawn up
    const double lower = -upper - 0.025 * bow;
    dvec3 colour = brush::over(below, dvec3(0.45, 0.13, 0.12), brush::inside(std::max({upper, lower, -0.02 * bow})));
    const double tongue = brush::ellipse(x, y + 0.104, 0.018, 0.011);
    return brush::over(colour, dvec3(0.93, 0.45, 0.42), brush::inside(std::max({tongue, lower + 0.001, upper})));
}

} // namespace

dvec3 coat(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    const double hem = 0.612;
    if (point.v > 0.705) return brush::cloth(darkBrown * 0.9, p);
    dvec3 colour = glm::mix(ochre, mustard, glm::smoothstep(0.55, 0.95, p.y));
    const double around = point.u * 1.2;
    colour = brush::over(colour, teal, brush::line(p.y - hem - 0.030, 0.012));
    colour = brush::over(colour, cream, brush::line(p.y - hem - 0.030, 0.0035));
    colour = brush::over(colour, cream, 0.8 * brush::stitches(p.y - hem - 0.054, around));
    if (p.z > 0.0)
    {
        colour = pockets(colour, p);
        const bool belowScarf = p.y < 1.18;
        colour = brush::over(colour, ochre * 0.58, belowScarf ? brush::line(p.x, 0.0028) : 0.0);
        colour = brush::over(colour, cream, 0.8 * brush::stitches(p.x - 0.050, p.y));
    }
    else
        colour = brush::over(colour, ochre * 0.7, brush::line(p.x, 0.0022));
    return brush::cloth(colour, p);
}

dvec3 sleeve(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    const dvec3 shoulder(0.150, 1.130, -0.010);
    const double along = glm::dot(p - shoulder, glm::normalize(dvec3(0.301, -0.301, 0.0)));
    dvec3 colour = mustard;
    const double elbow = brush::ellipse(along - 0.225, (point.u < 0.5 ? point.u : point.u - 1.0) * 0.42, 0.052, 0.040);
    colour = brush::over(colour, leatherBrown, brush::inside(elbow));
    colour = brush::over(colour, cream, 0.8 * brush::stitches(elbow + 0.006, point.u * 0.42 + along));
    colour = brush::over(colour, teal, brush::inside(0.386 - along));
    colour = brush::over(colour, cream, brush::line(along - 0.415, 0.0035));
    if (point.v > 0.86) colour = darkBrown;
    return brush::cloth(colour, p);
}

dvec3 trousers(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    dvec3 colour = indigo;
    const double patch = brush::roundedBox(p.x - 0.102, p.y - 0.415, 0.043, 0.050, 0.016);
    if (p.z > 0.0)
    {
        colour = brush::over(colour, indigo * 1.35, brush::inside(patch));
        colour = brush::over(colour, cream, 0.8 * brush::stitches(patch + 0.007, p.x + p.y));
    }
    return brush::cloth(colour, p);
}

dvec3 boot(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    const bool cuff = point.v < 0.44 && p.y > 0.222;
    if (cuff) return fleece(point);
    dvec3 colour = leatherBrown;
    colour = brush::over(colour, leatherBrown * 0.72, brush::inside(0.125 - p.z));
    colour = brush::over(colour, cream, 0.7 * brush::stitches(p.z - 0.117, p.x + p.y));
    const double x = p.x - 0.104;
    const bool tongue = p.z > 0.0 && p.y > 0.11;
    if (tongue)
        for (int lace = 0; lace < 3; ++lace)
        {
            const double height = p.y - 0.200 + lace * 0.030;
            const double crossed = std::min(std::abs(height - 0.4 * x), std::abs(height + 0.4 * x));
            colour = brush::over(colour, cream, std::abs(x) < 0.030 ? brush::line(crossed, 0.0028) : 0.0);
        }
    colour = brush::over(colour, leatherBrown * 0.75, p.z < 0.0 ? brush::inside(p.y - 0.095) : 0.0);
    return brush::hide(colour, p);
}

dvec3 sole(const SurfacePoint& point)
{
    const dvec3 colour = brush::over(darkBrown, darkBrown * 1.5, brush::line(point.position.y - 0.022, 0.002));
    return brush::hide(colour, point.position);
}

dvec3 glove(const SurfacePoint& point)
{
    const dvec3 colour(0.62, 0.27, 0.20);
    return brush::hide(colour, point.position);
}

dvec3 face(const SurfacePoint& point)
{
    const double x = point.position.x;
    const double y = point.position.y - 1.435;
    const double side = std::abs(x);
    dvec3 colour = glm::mix(skin, skin * dvec3(0.97, 0.90, 0.86), glm::smoothstep(0.05, -0.17, y));
    if (point.position.z < 0.0) return colour;
    const double blush = 1.0 - glm::smoothstep(0.0, 1.0, std::hypot((side - 0.118) / 0.048, (y + 0.062) / 0.036));
    colour = brush::over(colour, dvec3(0.96, 0.47, 0.38), 0.75 * blush);
    const double tip = 1.0 - glm::smoothstep(0.2, 1.0, std::hypot(x / 0.03, (y + 0.045) / 0.024));
    colour = brush::over(colour, dvec3(0.96, 0.56, 0.44), 0.6 * tip);
    for (const auto& [fx, fy] : {std::pair{0.040, -0.048}, {0.056, -0.058}, {0.058, -0.040}})
        colour = brush::over(colour, skin * 0.78, 0.7 * brush::inside(std::hypot(side - fx, y - fy) - 0.003));
    const double brow = y - 0.050 + 5.0 * (side - 0.075) * (side - 0.075);
    colour = brush::over(colour, ginger * 0.7, std::abs(side - 0.076) < 0.026 ? brush::line(brow, 0.0055) : 0.0);
    return side < 0.034 ? mouth(colour, x, y) : colour;
}

dvec3 eye(const SurfacePoint& point)
{
    const double angle = point.u * glm::two_pi<double>();
    const double radius = (1.0 - point.v) * 1.75; // one at the eye's outline
    const double x = radius * std::sin(angle);
    const double y = -radius * std::cos(angle);
    dvec3 colour(0.11, 0.07, 0.08);
    const double iris = 1.0 - glm::smoothstep(0.25, 0.75, std::hypot(x / 0.9, (y + 0.35) / 0.7));
    colour = brush::over(colour, dvec3(0.50, 0.27, 0.13), iris);
    colour = brush::over(colour, dvec3(1.0), brush::inside(std::hypot(x - 0.24, (y - 0.40) * 1.3) - 0.27, 0.05));
    return brush::over(colour, dvec3(0.9), brush::inside(std::hypot(x + 0.28, (y + 0.42) * 1.3) - 0.12, 0.05));
}

dvec3 hair(const SurfacePoint& point)
{
    const double streak = 0.5 + 0.5 * std::sin(point.u * glm::two_pi<double>() * 5.0);
    return glm::mix(ginger * 0.85, ginger * 1.15, streak) * (0.9 + 0.2 * point.v);
}

dvec3 hood(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    if (point.v < 0.30) return brush::cloth(darkBrown * 1.1, p);
    dvec3 colour = glm::mix(mustard, ochre, glm::smoothstep(-0.20, -0.40, p.z));
    const bool rim = p.z > 0.100;
    if (rim)
    {
        const double knit = 0.93 + 0.07 * std::sin(point.u * glm::two_pi<double>() * 60.0);
        return brush::cloth(cream * knit, p);
    }
    const double seam = (point.u - 0.5) * 1.4;
    colour = brush::over(colour, ochre * 0.62, brush::line(seam, 0.0028));
    colour = brush::over(colour, cream, 0.8 * brush::stitches(std::abs(seam) - 0.011, p.z - 0.6 * p.y));
    colour = brush::over(colour, cream, 0.8 * brush::stitches(p.z - 0.088, point.u * 1.4));
    return brush::cloth(colour, p);
}

dvec3 scarf(const SurfacePoint& point)
{
    const double rib = std::sin(point.v * glm::two_pi<double>() * 38.0 + 3.0 * std::sin(point.u * 6.283));
    return brush::cloth(teal * (1.0 + 0.10 * rib), point.position);
}

dvec3 scarfTail(const SurfacePoint& point)
{
    const double rib = std::sin(point.u * glm::two_pi<double>() * 16.0);
    dvec3 colour = teal;
    for (double band : {0.64, 0.72, 0.80})
        colour = brush::over(colour, cream, brush::line((point.v - band) * 0.5, 0.011));
    if (point.v > 0.87) colour = cream * (0.86 + 0.14 * (std::sin(point.u * glm::two_pi<double>() * 20.0) > 0.0));
    return brush::cloth(colour * (1.0 + 0.07 * rib), point.position);
}

dvec3 leather(const SurfacePoint& point)
{
    const double edge = std::min(std::abs(point.v - 0.32), std::abs(point.v - 0.68));
    return brush::hide(leatherBrown * (edge < 0.03 ? 1.15 : 1.0), point.position);
}

dvec3 satchel(const SurfacePoint& point)
{
    const dvec3& p = point.position;
    const double across = (point.u - 0.5) * 0.46;
    const bool flap = p.y > 0.775;
    dvec3 colour = flap ? leatherBrown * 0.86 : leatherBrown * 1.22;
    colour = brush::over(colour, cream, 0.75 * brush::stitches(p.y - (flap ? 0.789 : 0.712), point.u * 0.5));
    colour = brush::over(colour, darkBrown * 1.1, brush::line(across, 0.013));
    colour =
        brush::over(colour, brassYellow, brush::inside(brush::roundedBox(across, p.y - 0.762, 0.017, 0.014, 0.004)));
    colour = brush::over(colour, darkBrown, brush::inside(brush::roundedBox(across, p.y - 0.762, 0.009, 0.007, 0.002)));
    return brush::hide(colour, p);
}

dvec3 fleece(const SurfacePoint& point)
{
    return cream * (0.95 + 0.07 * noise(point.position * 90.0) + 0.05 * noise(point.position * 190.0));
}

dvec3 brass(const SurfacePoint&)
{
    return brassYellow;
}

dvec3 wool(const SurfacePoint& point)
{
    return dvec3(1.0, 0.92 + 0.04 * noise(point.position * 90.0), 0.0);
}

dvec3 skinned(const SurfacePoint&)
{
    return dvec3(1.0, 0.62, 0.0);
}

dvec3 wetEye(const SurfacePoint&)
{
    return dvec3(1.0, 0.12, 0.0);
}

dvec3 combed(const SurfacePoint&)
{
    return dvec3(1.0, 0.50, 0.0);
}

dvec3 waxed(const SurfacePoint& point)
{
    return dvec3(1.0, 0.46 + 0.12 * noise(point.position * 40.0), 0.0);
}

dvec3 satchelReflection(const SurfacePoint& point)
{
    const double across = (point.u - 0.5) * 0.46;
    const double height = point.position.y - 0.762;
    const double plate = brush::inside(brush::roundedBox(across, height, 0.017, 0.014, 0.004)) -
                         brush::inside(brush::roundedBox(across, height, 0.009, 0.007, 0.002));
    return brush::over(waxed(point), polished(point), plate);
}

dvec3 polished(const SurfacePoint& point)
{
    return dvec3(1.0, 0.30 + 0.08 * noise(point.position * 60.0), 1.0);
}

} // namespace osgGpuAnimation::scenes::wandererPaint
