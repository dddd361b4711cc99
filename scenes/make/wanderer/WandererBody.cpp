// SPDX-License-Identifier: MIT
#include "WandererBody.h"
#include "WandererBinders.h"
#include "WandererPaint.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

LoftRing wandererCoatRing(double height, double side, double front, double back)
{
    LoftRing ring = levelRing({0.0, height, -0.008}, side, front, back);
    ring.roundness = 0.88 + 0.12 * glm::smoothstep(0.75, 0.90, height); // room for the thighs
    return ring;
}

namespace
{

/// From the neck to the hem.
const std::vector<LoftRing> coatRings = {
    wandererCoatRing(1.225, 0.070, 0.070, 0.070), wandererCoatRing(1.190, 0.112, 0.090, 0.092),
    wandererCoatRing(1.150, 0.152, 0.108, 0.108), wandererCoatRing(1.100, 0.168, 0.126, 0.120),
    wandererCoatRing(1.020, 0.166, 0.136, 0.124), wandererCoatRing(0.940, 0.160, 0.135, 0.120),
    wandererCoatRing(0.880, 0.157, 0.131, 0.118), wandererCoatRing(0.830, 0.165, 0.138, 0.128),
    wandererCoatRing(0.760, 0.186, 0.156, 0.150), wandererCoatRing(0.690, 0.208, 0.174, 0.172),
    wandererCoatRing(0.625, 0.226, 0.190, 0.190)};

void addWandererCoat(CharacterMesh& mesh)
{
    std::vector<LoftRing> rings = refined(coatRings, 2);
    rings.push_back(wandererCoatRing(0.612, 0.226, 0.190, 0.190)); // the hem's edge, then up again inside
    rings.push_back(wandererCoatRing(0.612, 0.214, 0.178, 0.178));
    rings.push_back(wandererCoatRing(0.640, 0.205, 0.170, 0.170));
    rings.push_back(wandererCoatRing(0.720, 0.172, 0.142, 0.138));
    rings.push_back(wandererCoatRing(0.755, 0.000, 0.000, 0.000));
    mesh.add(loft(rings, 26, coatBinder(mesh.rig())), 432, 312, wandererPaint::coat, wandererPaint::wool);
}

} // namespace

void addWandererSleeves(CharacterMesh& mesh, const Painter& painter)
{
    const Rig& rig = mesh.rig();
    const glm::dvec3 shoulder = rig.head("UpperArm_L");
    const glm::dvec3 elbow = rig.head("LowerArm_L");
    const glm::dvec3 wrist = rig.head("Hand_L");
    const glm::dvec3 along = glm::normalize(wrist - shoulder);
    const glm::dvec3 forward(0.0, 0.0, 1.0);
    const auto upper = [&](double share, double side, double front)
    { return ringAcross(shoulder + (elbow - shoulder) * share, along, forward, side, front); };
    const auto lower = [&](double share, double side, double front)
    { return ringAcross(elbow + (wrist - elbow) * share, along, forward, side, front); };

    std::vector<LoftRing> rings = {
        ringAcross(shoulder + glm::dvec3(-0.075, -0.005, 0.0), {1.0, -0.25, 0.0}, forward, 0.070, 0.085),
        ringAcross(shoulder + glm::dvec3(-0.030, 0.005, 0.0), {1.0, -0.45, 0.0}, forward, 0.080, 0.088),
        ringAcross(shoulder + glm::dvec3(0.012, -0.004, 0.0), {1.0, -0.75, 0.0}, forward, 0.078, 0.080),
        upper(0.35, 0.070, 0.071),
        upper(0.70, 0.064, 0.066),
        upper(1.00, 0.062, 0.064),
        lower(0.35, 0.062, 0.063),
        lower(0.75, 0.063, 0.064)};
    rings = refined(rings, 2);
    const LoftRing edge = lower(0.80, 0.064, 0.065);
    const LoftRing cuff = lower(0.81, 0.073, 0.074);
    const LoftRing end = lower(1.02, 0.077, 0.078);
    const LoftRing inside = lower(1.02, 0.066, 0.067);
    for (const LoftRing& ring : {edge, cuff, cuff, end, end, inside, lower(0.90, 0.050, 0.050), lower(0.88, 0.0, 0.0)})
        rings.push_back(ring);
    mesh.addPair(loft(rings, 13, armBinder(rig)), 200, 280, painter, wandererPaint::wool);
}

void addWandererGloves(CharacterMesh& mesh, const Painter& painter)
{
    const Rig& rig = mesh.rig();
    const glm::dvec3 wrist = rig.head("Hand_L");
    const glm::dvec3 along = glm::normalize(rig.head("FingerTips_L") - wrist);
    const glm::dvec3 forward(0.0, 0.0, 1.0);
    const auto at = [&](double metres, double thickness, double width)
    { return ringAcross(wrist + along * metres, along, forward, thickness, width); };
    const std::vector<LoftRing> hand = {at(-0.035, 0.034, 0.040), at(0.000, 0.035, 0.043), at(0.030, 0.038, 0.054),
                                        at(0.065, 0.039, 0.062),  at(0.095, 0.037, 0.061), at(0.125, 0.034, 0.057),
                                        at(0.155, 0.030, 0.047),  at(0.178, 0.021, 0.030), at(0.188, 0.000, 0.000)};
    mesh.addPair(loft(refined(hand, 2), 12, gloveBinder(rig)), 132, 132, painter, wandererPaint::waxed);

    const glm::dvec3 root = rig.head("Thumb_L");
    const glm::dvec3 tip = glm::normalize(glm::dvec3(0.028, -0.030, 0.050));
    const auto thumbAt = [&](double metres, double radius) {
        return ringAcross(root + tip * metres, tip, {0.7, 0.7, 0.0}, radius, radius);
    };
    const std::vector<LoftRing> thumb = {thumbAt(-0.020, 0.020), thumbAt(0.010, 0.024), thumbAt(0.040, 0.024),
                                         thumbAt(0.066, 0.021),  thumbAt(0.080, 0.013), thumbAt(0.085, 0.0)};
    const int handJoint = rig.index("Hand_L");
    const int thumbJoint = rig.index("Thumb_L");
    const auto binder = [=](const glm::dvec3& position, const LoftRing&)
    {
        const double out = glm::dot(position - root, tip) / 0.03;
        return Binding(handJoint).give(std::min(std::max(out, 0.0), 1.0), thumbJoint);
    };
    mesh.addPair(loft(thumb, 8, binder), 60, 60, painter, wandererPaint::waxed);
}

void addWandererTrousers(CharacterMesh& mesh, const Painter& painter)
{
    const auto at = [](double height, double x, double z, double side, double front, double back) {
        return levelRing({x, height, z}, side, front, back);
    };
    const std::vector<LoftRing> rings = {
        at(0.760, 0.088, -0.005, 0.020, 0.030, 0.030), at(0.735, 0.090, -0.005, 0.064, 0.076, 0.080),
        at(0.660, 0.094, 0.000, 0.077, 0.082, 0.086),  at(0.580, 0.097, 0.004, 0.081, 0.084, 0.084),
        at(0.490, 0.100, 0.010, 0.078, 0.080, 0.079),  at(0.400, 0.102, 0.013, 0.077, 0.080, 0.076),
        at(0.320, 0.103, 0.006, 0.076, 0.078, 0.078),  at(0.270, 0.104, 0.000, 0.072, 0.074, 0.076),
        at(0.220, 0.104, -0.004, 0.060, 0.060, 0.060), at(0.215, 0.104, -0.004, 0.0, 0.0, 0.0)};
    mesh.addPair(loft(refined(rings, 2), 13, legBinder(mesh.rig())), 170, 210, painter, wandererPaint::wool);
}

namespace
{

/// A ring of the boot between ankle and toe: `tilt` degrees from level to upright, from instep down to the sole.
LoftRing footRing(double y, double z, double tilt, double side, double instep, double under)
{
    const double angle = glm::radians(tilt);
    LoftRing ring;
    ring.center = {0.106 + 0.04 * z, y, z};
    ring.side = {side, 0.0, 0.0};
    ring.front = glm::dvec3(0.0, std::sin(angle), std::cos(angle)) * instep;
    ring.back = under / instep;
    ring.roundness = 0.92;
    return ring;
}

} // namespace

void addWandererBoots(CharacterMesh& mesh, const Painter& boot, const Painter& sole)
{
    const auto shaft = [](double height, double z, double side, double front, double back) {
        return levelRing({0.104, height, z}, side, front, back);
    };
    const LoftRing cuffLow = shaft(0.232, -0.004, 0.094, 0.096, 0.098);
    std::vector<LoftRing> rings = {shaft(0.255, -0.003, 0.000, 0.000, 0.000), shaft(0.262, -0.003, 0.074, 0.076, 0.078),
                                   shaft(0.292, -0.003, 0.081, 0.083, 0.085), shaft(0.298, -0.003, 0.088, 0.090, 0.092),
                                   shaft(0.290, -0.003, 0.094, 0.096, 0.098), cuffLow,
                                   shaft(0.224, -0.005, 0.088, 0.090, 0.092), shaft(0.224, -0.005, 0.076, 0.078, 0.080),
                                   shaft(0.224, -0.005, 0.076, 0.078, 0.080)};
    const std::vector<LoftRing> foot = {
        shaft(0.224, -0.005, 0.076, 0.078, 0.080),         shaft(0.170, -0.008, 0.073, 0.076, 0.074),
        footRing(0.125, -0.006, 8.0, 0.072, 0.080, 0.078), footRing(0.086, 0.006, 37.0, 0.075, 0.080, 0.112),
        footRing(0.074, 0.035, 58.0, 0.075, 0.066, 0.074), footRing(0.062, 0.075, 76.0, 0.080, 0.054, 0.052),
        footRing(0.056, 0.115, 86.0, 0.085, 0.050, 0.044), footRing(0.053, 0.155, 92.0, 0.082, 0.047, 0.040),
        footRing(0.050, 0.190, 96.0, 0.062, 0.038, 0.034), footRing(0.048, 0.210, 98.0, 0.034, 0.022, 0.020),
        footRing(0.047, 0.217, 98.0, 0.000, 0.001, 0.001)};
    for (const LoftRing& ring : refined(foot, 1))
        rings.push_back(ring);
    rings.back().front = glm::dvec3(0.0);
    mesh.addPair(loft(rings, 14, legBinder(mesh.rig())), 240, 246, boot, wandererPaint::waxed);

    const auto slab = [](double height, double grow, double side)
    {
        LoftRing ring = levelRing({0.110, height, 0.050}, side + grow, 0.168 + grow, 0.130 + grow);
        ring.roundness = 0.90;
        return ring;
    };
    const std::vector<LoftRing> slabs = {levelRing({0.110, 0.0, 0.065}, 0.0, 0.0, 0.0),
                                         slab(0.000, -0.006, 0.080),
                                         slab(0.000, -0.006, 0.080),
                                         slab(0.008, 0.000, 0.082),
                                         slab(0.026, 0.000, 0.084),
                                         slab(0.026, 0.000, 0.084),
                                         slab(0.034, -0.012, 0.080),
                                         levelRing({0.110, 0.040, 0.065}, 0.0, 0.0, 0.0)};
    mesh.addPair(loft(slabs, 16, legBinder(mesh.rig())), 180, 60, sole, wandererPaint::waxed);
}

const std::vector<LoftRing>& wandererCoatRings()
{
    return coatRings;
}

LoftRing wandererCoatAt(double height)
{
    const std::vector<LoftRing> rings = refined(coatRings, 8);
    for (const LoftRing& ring : rings)
        if (ring.center.y <= height) return ring;
    return rings.back();
}

void addWandererBody(CharacterMesh& mesh)
{
    addWandererCoat(mesh);
    addWandererBoots(mesh, wandererPaint::boot, wandererPaint::sole);
    addWandererSleeves(mesh, wandererPaint::sleeve);
    addWandererTrousers(mesh, wandererPaint::trousers);
    addWandererGloves(mesh, wandererPaint::glove);
}

} // namespace osgGpuAnimation::scenes
