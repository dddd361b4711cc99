// SPDX-License-Identifier: MIT
#include "SerpentBody.h"
#include "../AmbientOcclusion.h"
#include "../CharacterMesh.h"
#include "SerpentPaint.h"
#include "SerpentRig.h"
#include "SerpentScales.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

LoftRing uprightRing(double distance, double height, double side, double up, double down)
{
    LoftRing ring;
    ring.center = {0.0, serpentHeight + height, serpentNeck - distance};
    ring.side = {side, 0.0, 0.0};
    ring.front = {0.0, up, 0.0};
    ring.back = up > 0.0 ? down / up : 1.0;
    return ring;
}

/// Half the body's thickness in metres.
double girth(double distance)
{
    const double share = distance / serpentLength;
    const double neck = glm::mix(0.086, 0.122, glm::smoothstep(0.0, 0.22, share));
    return neck * std::pow(std::max(0.0, 1.0 - std::pow(share, 1.7)), 0.75) + 0.004;
}

Binder chainBinder(const Rig& rig)
{
    return [&rig](const glm::dvec3& position, const LoftRing&)
    { return serpentBindingAt(rig, serpentNeck - position.z); };
}

Binder rigid(const Rig& rig, const std::string& joint)
{
    const int index = rig.index(joint);
    return [index](const glm::dvec3&, const LoftRing&) { return Binding(index); };
}

Part body(const Rig& rig)
{
    std::vector<LoftRing> rings = {
        uprightRing(-0.345, -0.006, 0.0, 0.0, 0.0),       uprightRing(-0.342, -0.006, 0.030, 0.020, 0.014),
        uprightRing(-0.325, -0.002, 0.058, 0.036, 0.024), uprightRing(-0.285, 0.004, 0.080, 0.050, 0.034),
        uprightRing(-0.235, 0.012, 0.096, 0.062, 0.044),  uprightRing(-0.180, 0.020, 0.113, 0.078, 0.056),
        uprightRing(-0.120, 0.020, 0.122, 0.090, 0.070),  uprightRing(-0.060, 0.010, 0.110, 0.092, 0.080),
        uprightRing(-0.020, 0.003, 0.094, 0.090, 0.084)};
    const int steps = 84;
    for (int step = 1; step <= steps; ++step)
    {
        const double distance = serpentLength * step / steps;
        const double radius = girth(distance);
        rings.push_back(uprightRing(distance, 0.0, radius, radius * 1.06, radius * 0.92));
    }
    rings.push_back(uprightRing(serpentLength + 0.01, 0.0, 0.0, 0.0, 0.0));
    Part part = loft(rings, 16, chainBinder(rig));
    part.painter = serpentPaint::scales;
    return part;
}

Part jaw(const Rig& rig)
{
    const auto at = [](double z, double height, double side, double up, double down)
    { return uprightRing(-z, height, side, up, down); };
    const std::vector<LoftRing> rings = {at(0.318, -0.052, 0.0, 0.0, 0.0),       at(0.314, -0.052, 0.026, 0.008, 0.010),
                                         at(0.285, -0.053, 0.054, 0.012, 0.018), at(0.220, -0.056, 0.076, 0.014, 0.024),
                                         at(0.150, -0.056, 0.092, 0.018, 0.030), at(0.080, -0.050, 0.088, 0.030, 0.034),
                                         at(0.030, -0.045, 0.060, 0.020, 0.030), at(0.020, -0.045, 0.0, 0.0, 0.0)};
    Part part = loft(rings, 12, rigid(rig, "Jaw"));
    part.painter = serpentPaint::jaw;
    return part;
}

Part eye(const Rig& rig)
{
    const glm::dvec3 outward = glm::normalize(glm::dvec3(0.86, 0.42, 0.35));
    const glm::dvec3 side = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), outward));
    const glm::dvec3 place(0.083, serpentHeight + 0.066, serpentNeck + 0.175);
    Part part = loft(ellipsoid(place, outward * 0.028, side * 0.042, glm::cross(outward, side) * 0.044, 11), 14,
                     rigid(rig, "Head"));
    part.painter = serpentPaint::eye;
    return part;
}

/// A thin sheet that stands on the back from head to tail, higher where a ray of the fin is.
Part crest(const Rig& rig)
{
    std::vector<LoftRing> rings;
    const int steps = 96;
    for (int step = 0; step <= steps; ++step)
    {
        const double share = static_cast<double>(step) / steps;
        const double distance = -0.06 + share * (serpentLength - 0.05);
        const double outline = std::pow(std::sin(glm::pi<double>() * std::min(1.0, 0.04 + share * 0.97)), 0.6);
        const double ray = 0.80 + 0.20 * std::abs(std::cos(glm::pi<double>() * step / 4.0));
        const double height = step == steps ? 0.0 : 0.115 * outline * ray;
        LoftRing ring;
        ring.center = {0.0, serpentHeight + girth(std::max(0.0, distance)) * 0.9, serpentNeck - distance};
        ring.side = {step == steps ? 0.0 : 0.007, 0.0, 0.0};
        ring.front = {0.0, height, -0.35 * height}; // leaning back
        ring.back = 0.1;
        rings.push_back(ring);
    }
    const auto binder = [&rig](const glm::dvec3&, const LoftRing& ring)
    { return serpentBindingAt(rig, serpentNeck - ring.center.z); };
    Part part = loft(rings, 6, binder);
    part.painter = serpentPaint::fin;
    return part;
}

/// The tail's fan, upright.
Part tail(const Rig& rig)
{
    std::vector<LoftRing> rings;
    const int steps = 24;
    for (int step = 0; step <= steps; ++step)
    {
        const double share = static_cast<double>(step) / steps;
        const bool end = step == 0 || step == steps;
        const double late = std::max(0.0, (share - 0.55) / 0.45);
        const double outline = glm::smoothstep(-0.1, 0.7, share) * std::sqrt(std::max(0.0, 1.0 - late * late));
        const double ray = 0.95 + 0.05 * std::cos(glm::two_pi<double>() * step / 3.0);
        const double height = end ? 0.0 : 0.22 * outline * ray;
        LoftRing ring;
        ring.center = {0.0, serpentHeight, serpentNeck - (serpentLength - 0.30 + 0.52 * share)};
        ring.side = {end ? 0.0 : 0.007 * (1.0 - 0.7 * share), 0.0, 0.0};
        ring.front = {0.0, height, 0.0};
        rings.push_back(ring);
    }
    const auto binder = [&rig](const glm::dvec3&, const LoftRing& ring)
    { return serpentBindingAt(rig, serpentNeck - ring.center.z); };
    Part part = loft(rings, 8, binder);
    part.painter = serpentPaint::fin;
    return part;
}

Part sideFin(const Rig& rig)
{
    const glm::dvec3 root = rig.head("Fin_L");
    const glm::dvec3 outward = glm::normalize(glm::dvec3(0.80, -0.34, -0.50));
    const glm::dvec3 width = glm::normalize(glm::dvec3(0.30, 0.10, -0.90));
    std::vector<LoftRing> rings;
    for (int step = 0; step <= 10; ++step)
    {
        const double share = step / 10.0;
        const double half = step == 10 ? 0.0 : 0.035 + 0.085 * std::pow(std::sin(glm::pi<double>() * share), 0.8);
        LoftRing ring;
        ring.center = root + outward * (0.34 * share - 0.03) + width * (0.10 * share * share);
        ring.side = width * half;
        ring.front = glm::normalize(glm::cross(width, outward)) * (step == 10 ? 0.0 : 0.016 * (1.0 - 0.8 * share));
        rings.push_back(ring);
    }
    const int joint = rig.index("Fin_L");
    const int spine = rig.index("Spine3");
    const auto binder = [=](const glm::dvec3& position, const LoftRing&)
    { return Binding(spine).give(glm::smoothstep(-0.01, 0.08, glm::dot(position - root, outward)), joint); };
    Part part = loft(rings, 10, binder);
    part.painter = serpentPaint::fin;
    return part;
}

/// glTF wants vertex colours linear; painters think in sRGB.
glm::dvec3 linear(const glm::dvec3& colour)
{
    glm::dvec3 result;
    for (int channel = 0; channel < 3; ++channel)
    {
        const double value = std::clamp(colour[channel], 0.0, 1.0);
        result[channel] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    }
    return result;
}

void appendColours(PrimitiveArrays& arrays, const Part& part)
{
    for (int row = 0; row < part.rows; ++row)
        for (int column = 0; column < part.columns; ++column)
        {
            const int vertex = part.vertexAt(row, column);
            const double u = static_cast<double>(column) / (part.columns - 1);
            const glm::dvec3 colour = part.painter({u, part.along[row], part.positions[vertex]});
            arrays.colours.push_back(linear(colour * glm::mix(0.45, 1.0, part.light[vertex])));
        }
}

} // namespace

SerpentArrays serpentArrays(const Rig& rig)
{
    std::vector<Part> parts = {body(rig), jaw(rig), crest(rig), tail(rig), eye(rig), sideFin(rig)};
    parts.push_back(mirrored(parts[4], rig));
    parts.push_back(mirrored(parts[5], rig));
    const double reach = 0.15; // metres
    computeLight(parts, {}, reach);
    SerpentArrays result;
    for (const Part& part : parts)
    {
        const bool hasScales = &part == &parts.front();
        PrimitiveArrays& arrays = hasScales ? result.scales : result.smooth;
        appendPart(arrays, part);
        appendBindings(arrays, part);
        appendColours(arrays, part);
        if (hasScales) appendScales(arrays, part);
    }
    return result;
}

} // namespace osgGpuAnimation::scenes
