// SPDX-License-Identifier: MIT
#include "WandererGear.h"
#include "../ChainBinding.h"
#include "WandererBinders.h"
#include "WandererBody.h"
#include "WandererPaint.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

/// Wound around the neck: a closed loop of rings around the Y axis, in two turns of different thickness.
void addWound(CharacterMesh& mesh, const Painter& painter)
{
    std::vector<LoftRing> rings;
    const int steps = 24;
    for (int step = 0; step <= steps; ++step)
    {
        const double angle = glm::two_pi<double>() * (step % steps) / steps;
        const glm::dvec3 outward(std::sin(angle), 0.0, -std::cos(angle));
        const double lump = 0.006 * std::cos(3.0 * angle + 0.6) + 0.004 * std::cos(5.0 * angle);
        const glm::dvec3 center = glm::dvec3(0.0, 1.208 + 0.010 * std::cos(angle), -0.008) +
                                  glm::dvec3(outward.x * 0.128, 0.0, outward.z * 0.112);
        LoftRing ring;
        ring.center = center;
        ring.side = glm::dvec3(0.0, 0.050 + lump, 0.0) + outward * 0.012;
        ring.front = outward * (0.047 - lump);
        rings.push_back(ring);
    }
    const int chest = mesh.rig().index("Chest");
    const int neck = mesh.rig().index("Neck");
    const auto binder = [=](const glm::dvec3& position, const LoftRing&)
    { return Binding(chest).give(glm::smoothstep(1.17, 1.27, position.y) * 0.6, neck); };
    mesh.add(loft(rings, 10, binder), 108, 296, painter, wandererPaint::wool);
}

void addScarfTail(CharacterMesh& mesh, const Painter& painter)
{
    const Rig& rig = mesh.rig();
    const glm::dvec3 sideward = glm::normalize(glm::dvec3(1.0, 0.0, -0.12));
    const auto at = [&](double x, double y, double z, double width, double thickness)
    {
        LoftRing ring = ringAcross({x, y, z}, {0.1, -1.0, -0.2}, {0.0, 0.0, -1.0}, width, thickness);
        ring.side = sideward * width;
        ring.roundness = 0.75;
        return ring;
    };
    const std::vector<LoftRing> rings = {at(0.040, 1.235, -0.120, 0.040, 0.016), at(0.050, 1.200, -0.160, 0.046, 0.020),
                                         at(0.056, 1.130, -0.195, 0.048, 0.014), at(0.060, 1.070, -0.215, 0.052, 0.012),
                                         at(0.066, 0.990, -0.232, 0.058, 0.012), at(0.070, 0.920, -0.245, 0.062, 0.012),
                                         at(0.075, 0.840, -0.256, 0.066, 0.012), at(0.080, 0.775, -0.264, 0.068, 0.011),
                                         at(0.080, 0.770, -0.264, 0.000, 0.000)};
    ChainBinding tail(rig.index("Chest"));
    tail.then(rig.index("Scarf1"), rig.head("Scarf1"), {0.0, -1.0, -0.4}, 0.03)
        .then(rig.index("Scarf2"), rig.head("Scarf2"), {0.0, -1.0, -0.2}, 0.07)
        .then(rig.index("Scarf3"), rig.head("Scarf3"), {0.0, -1.0, -0.2}, 0.07);
    const auto binder = [=](const glm::dvec3&, const LoftRing& ring) { return tail.at(ring.center); };
    mesh.add(loft(refined(rings, 2), 8, binder), 128, 220, painter, wandererPaint::wool);
}

/// The coat's outline at a height, `off` metres farther out.
LoftRing band(double height, double off)
{
    const LoftRing ring = wandererCoatAt(height);
    const double front = glm::length(ring.front);
    return levelRing({0.0, height, ring.center.z}, ring.side.x + off, front + off, front * ring.back + off);
}

} // namespace

void addWandererBelt(CharacterMesh& mesh)
{
    const std::vector<LoftRing> belt = {band(0.884, -0.01), band(0.884, 0.008), band(0.884, 0.008), band(0.868, 0.011),
                                        band(0.850, 0.009), band(0.850, 0.009), band(0.850, -0.01)};
    mesh.add(loft(belt, 26, coatBinder(mesh.rig())), 240, 28, wandererPaint::leather, wandererPaint::waxed);
}

void addWandererBuckle(CharacterMesh& mesh)
{
    const double front = band(0.867, 0.012).front.z - 0.008;
    const auto plate = [&](double z, double half)
    {
        LoftRing ring;
        ring.center = {0.0, 0.867, front + z};
        ring.side = {half * 1.25, 0.0, 0.0};
        ring.front = {0.0, half, 0.0};
        ring.roundness = 0.45;
        return ring;
    };
    const std::vector<LoftRing> buckle = {plate(-0.004, 0.0), plate(-0.004, 0.026), plate(0.006, 0.027),
                                          plate(0.009, 0.023), plate(0.009, 0.0)};
    mesh.add(loft(buckle, 12, coatBinder(mesh.rig())), 60, 40, wandererPaint::brass, wandererPaint::polished);
}

void addWandererButtons(CharacterMesh& mesh)
{
    for (double height : {1.115, 1.035, 0.955})
    {
        const LoftRing coat = wandererCoatAt(height);
        const glm::dvec3 place(0.026, height, coat.center.z + coat.front.z * 0.985);
        const std::vector<LoftRing> disc = ellipsoid(place, {0.0, 0.0, 0.010}, {0.017, 0.0, 0.0}, {0.0, 0.017, 0.0}, 5);
        mesh.add(loft(disc, 8, coatBinder(mesh.rig())), 28, 28, wandererPaint::brass, wandererPaint::polished);
    }
}

namespace
{

/// The strap's middle: from under the scarf on the left, over the chest, to the satchel on the right hip, and back.
glm::dvec3 strapAt(double angle)
{
    const double height = 0.985 + 0.195 * std::cos(angle);
    const LoftRing coat = wandererCoatAt(height);
    const double depth = std::sin(angle) > 0.0 ? glm::length(coat.front) : glm::length(coat.front) * coat.back;
    const glm::dvec3 outward(std::cos(angle), 0.15, std::sin(angle));
    return glm::dvec3(coat.side.x * std::cos(angle), height, coat.center.z + depth * std::sin(angle)) +
           0.005 * glm::normalize(outward);
}

void addStrap(CharacterMesh& mesh)
{
    std::vector<LoftRing> rings;
    const int steps = 26;
    for (int step = 0; step <= steps; ++step)
    {
        const double angle = glm::two_pi<double>() * (step % steps) / steps;
        const glm::dvec3 outward = glm::normalize(glm::dvec3(std::cos(angle), 0.15, std::sin(angle)));
        LoftRing ring =
            ringAcross(strapAt(angle), strapAt(angle + 0.02) - strapAt(angle - 0.02), outward, 0.018, 0.007);
        ring.roundness = 0.6;
        rings.push_back(ring);
    }
    mesh.add(loft(rings, 6, coatBinder(mesh.rig())), 40, 280, wandererPaint::leather, wandererPaint::waxed);
}

void addSatchel(CharacterMesh& mesh)
{
    const glm::dvec3 outward = glm::normalize(glm::dvec3(-0.75, 0.10, -0.66));
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.0, 1.0, 0.0) - outward * outward.y);
    const glm::dvec3 sideward = glm::cross(up, outward);
    const glm::dvec3 center(-0.170, 0.775, -0.135);
    const auto section = [&](double height, double width, double depth)
    {
        LoftRing ring;
        ring.center = center + up * height;
        ring.side = sideward * width;
        ring.front = outward * depth;
        ring.roundness = 0.55;
        return ring;
    };
    const std::vector<LoftRing> bag = {section(-0.085, 0.0, 0.0),     section(-0.085, 0.068, 0.030),
                                       section(-0.072, 0.086, 0.046), section(-0.020, 0.092, 0.052),
                                       section(0.006, 0.092, 0.052),  section(0.006, 0.099, 0.060),
                                       section(0.040, 0.098, 0.058),  section(0.066, 0.090, 0.046),
                                       section(0.076, 0.070, 0.030),  section(0.078, 0.0, 0.0)};
    mesh.add(loft(bag, 18, rigidBinder(mesh.rig().index("Hips"))), 260, 150, wandererPaint::satchel,
             wandererPaint::satchelReflection);
}

} // namespace

void addWandererScarf(CharacterMesh& mesh, const Painter& scarf, const Painter& tail)
{
    addWound(mesh, scarf);
    addScarfTail(mesh, tail);
}

void addWandererBag(CharacterMesh& mesh)
{
    addStrap(mesh);
    addSatchel(mesh);
}

void addWandererGear(CharacterMesh& mesh)
{
    addWound(mesh, wandererPaint::scarf);
    addStrap(mesh);
    addScarfTail(mesh, wandererPaint::scarfTail);
    addSatchel(mesh);
    addWandererBelt(mesh);
    addWandererBuckle(mesh);
    addWandererButtons(mesh);
}

} // namespace osgGpuAnimation::scenes
