// SPDX-License-Identifier: MIT
#include "LoftRing.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

double power(double value, double exponent)
{
    return std::copysign(std::pow(std::abs(value), exponent), value);
}

bool same(const LoftRing& a, const LoftRing& b)
{
    return a.center == b.center && a.side == b.side && a.front == b.front;
}

template <typename T>
T catmullRom(const T& before, const T& from, const T& to, const T& after, double t)
{
    return 0.5 * (2.0 * from + (to - before) * t + (2.0 * before - 5.0 * from + 4.0 * to - after) * (t * t) +
                  (3.0 * from - before - 3.0 * to + after) * (t * t * t));
}

LoftRing between(const LoftRing& before, const LoftRing& from, const LoftRing& to, const LoftRing& after, double t)
{
    LoftRing ring;
    ring.center = catmullRom(before.center, from.center, to.center, after.center, t);
    ring.side = catmullRom(before.side, from.side, to.side, after.side, t);
    ring.front = catmullRom(before.front, from.front, to.front, after.front, t);
    ring.back = from.back + (to.back - from.back) * t;
    ring.roundness = from.roundness + (to.roundness - from.roundness) * t;
    return ring;
}

} // namespace

glm::dvec3 LoftRing::pointAt(double angle) const
{
    const double forward = -power(std::cos(angle), roundness);
    const double sideward = power(std::sin(angle), roundness);
    return center + side * sideward + front * (forward < 0.0 ? forward * back : forward);
}

LoftRing levelRing(const glm::dvec3& center, double side, double front, double back)
{
    return {center, {side, 0.0, 0.0}, {0.0, 0.0, front}, front > 0.0 ? back / front : 1.0, 1.0};
}

LoftRing ringAcross(const glm::dvec3& center, const glm::dvec3& direction, const glm::dvec3& frontward, double side,
                    double front)
{
    const glm::dvec3 sideward = glm::normalize(glm::cross(frontward, direction));
    const glm::dvec3 squareFront = glm::normalize(glm::cross(direction, sideward));
    return {center, sideward * side, squareFront * front, 1.0, 1.0};
}

std::vector<LoftRing> ellipsoid(const glm::dvec3& center, const glm::dvec3& axis, const glm::dvec3& side,
                                const glm::dvec3& front, int rings)
{
    std::vector<LoftRing> result;
    for (int ring = 0; ring < rings; ++ring)
    {
        const double angle = glm::pi<double>() * ring / (rings - 1);
        const bool pole = ring == 0 || ring == rings - 1;
        const double radius = pole ? 0.0 : std::sin(angle);
        result.push_back({center - axis * std::cos(angle), side * radius, front * radius, 1.0, 1.0});
    }
    return result;
}

std::vector<LoftRing> refined(const std::vector<LoftRing>& rings, int steps)
{
    std::vector<LoftRing> result;
    for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    {
        result.push_back(rings[i]);
        if (same(rings[i], rings[i + 1])) continue;
        const bool startsHard = i == 0 || same(rings[i - 1], rings[i]);
        const bool endsHard = i + 2 == rings.size() || same(rings[i + 1], rings[i + 2]);
        const LoftRing& before = rings[startsHard ? i : i - 1];
        const LoftRing& after = rings[endsHard ? i + 1 : i + 2];
        for (int step = 1; step < steps; ++step)
            result.push_back(between(before, rings[i], rings[i + 1], after, static_cast<double>(step) / steps));
    }
    result.push_back(rings.back());
    return result;
}

} // namespace osgGpuAnimation::scenes
