// SPDX-License-Identifier: MIT
#include "PeopleHeads.h"
#include "../wanderer/WandererBinders.h"
#include "../wanderer/WandererHead.h"
#include "../wanderer/WandererPaint.h"
#include "PeoplePaint.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

const glm::dvec3 center = wandererFaceCenter;

Binder headBinder(const CharacterMesh& mesh)
{
    return rigidBinder(mesh.rig().index("Head"));
}

/// A circle on an ellipsoid around the face: `degrees` from the pole, which lies in the direction (0, up, front) of the
/// unit sphere.
LoftRing cap(const glm::dvec3& half, double up, double front, double degrees)
{
    const glm::dvec3 pole = glm::normalize(glm::dvec3(0.0, up, front));
    const double angle = glm::radians(degrees);
    LoftRing ring;
    ring.center = center + half * pole * std::cos(angle);
    ring.side = half * glm::dvec3(1.0, 0.0, 0.0) * std::sin(angle);
    ring.front = half * glm::dvec3(0.0, -pole.z, pole.y) * std::sin(angle);
    return ring;
}

/// Turned about the X axis through a place, forward is +.
std::vector<LoftRing> tilted(std::vector<LoftRing> rings, const glm::dvec3& place, double degrees)
{
    const glm::dquat turn = glm::angleAxis(glm::radians(degrees), glm::dvec3(1.0, 0.0, 0.0));
    for (LoftRing& ring : rings)
    {
        ring.center = place + turn * (ring.center - place);
        ring.side = turn * ring.side;
        ring.front = turn * ring.front;
    }
    return rings;
}

void addHair(CharacterMesh& mesh)
{
    const glm::dvec3 half(0.211, 0.200, 0.196);
    const double up = 0.72, front = -0.69;
    std::vector<LoftRing> rings = {cap({0.190, 0.176, 0.172}, up, front, 96.0),
                                   cap({0.202, 0.190, 0.186}, up, front, 95.0), cap(half, up, front, 90.0)};
    for (double degrees : {80.0, 70.0, 58.0, 46.0, 34.0, 22.0, 11.0, 0.0})
        rings.push_back(cap(half, up, front, degrees));
    mesh.wear("Hair", "Hair");
    mesh.add(loft(rings, 24, headBinder(mesh)), 300, 200, peoplePaint::hair, wandererPaint::combed);
    addWandererFringe(mesh, peoplePaint::hair);
}

void addBun(CharacterMesh& mesh)
{
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.0, 0.15, -1.0)) * 0.062;
    const std::vector<LoftRing> bun = ellipsoid({0.0, 1.425, -0.215}, axis, {0.070, 0.0, 0.0},
                                                glm::normalize(glm::dvec3(0.0, 1.0, 0.15)) * 0.066, 10);
    mesh.wear("Bun", "Hair");
    mesh.add(loft(bun, 16, headBinder(mesh)), 110, 80, peoplePaint::hair, wandererPaint::combed);
}

void addBeard(CharacterMesh& mesh)
{
    const double up = -0.93, front = 0.36;
    const auto at = [&](double side, double down, double forward, double degrees) {
        return cap({side, down, forward}, up, front, degrees);
    };
    const std::vector<LoftRing> rings = {at(0.190, 0.174, 0.170, 34.0), at(0.205, 0.190, 0.186, 33.5),
                                         at(0.217, 0.203, 0.200, 29.0), at(0.217, 0.214, 0.208, 23.0),
                                         at(0.217, 0.226, 0.216, 15.0), at(0.217, 0.236, 0.222, 7.0),
                                         at(0.217, 0.238, 0.224, 0.0)};
    mesh.wear("Beard", "Hair");
    mesh.add(loft(rings, 18, headBinder(mesh)), 140, 70, peoplePaint::hair, wandererPaint::combed);
}

void addHat(CharacterMesh& mesh)
{
    const double z = 0.004;
    const auto at = [&](double height, double radius) {
        return levelRing({0.0, height, z}, radius, radius * 0.97, radius * 0.99);
    };
    std::vector<LoftRing> rings = {at(1.538, 0.0),   at(1.538, 0.196), at(1.524, 0.212), at(1.516, 0.262),
                                   at(1.520, 0.318), at(1.526, 0.326), at(1.532, 0.320), at(1.530, 0.264),
                                   at(1.538, 0.216), at(1.552, 0.209)};
    const std::vector<LoftRing> crown = {at(1.552, 0.209), at(1.600, 0.200), at(1.660, 0.186), at(1.705, 0.172),
                                         at(1.732, 0.142), at(1.738, 0.105), at(1.726, 0.060), at(1.718, 0.0)};
    const std::vector<LoftRing> smooth = refined(crown, 2);
    rings.insert(rings.end(), smooth.begin() + 1, smooth.end());
    for (LoftRing& ring : rings) // the brim rises at both sides and dips in front and behind
        if (ring.side.x > 0.24) ring.center.y -= 0.004;
    rings = tilted(rings, {0.0, 1.53, 0.0}, -9.0);
    mesh.wear("Hat", "Hat");
    const Part part = loft(rings, 28, headBinder(mesh));
    mesh.add(part, 330, 240, peoplePaint::hat(part.along[10]), wandererPaint::wool);
}

void addCap(CharacterMesh& mesh)
{
    const auto at = [&](double height, double radius) {
        return levelRing({0.0, height, 0.004}, radius * 1.02, radius * 0.985, radius);
    };
    std::vector<LoftRing> rings = {at(1.545, 0.0),   at(1.530, 0.200), at(1.508, 0.206), at(1.500, 0.216),
                                   at(1.506, 0.228), at(1.525, 0.234), at(1.548, 0.232), at(1.562, 0.224),
                                   at(1.564, 0.212), at(1.564, 0.212)};
    const std::vector<LoftRing> dome = {at(1.564, 0.212), at(1.610, 0.186), at(1.650, 0.142), at(1.676, 0.086),
                                        at(1.686, 0.0)};
    const std::vector<LoftRing> smooth = refined(dome, 3);
    rings.insert(rings.end(), smooth.begin() + 1, smooth.end());
    const glm::dvec3 pivot(0.0, 1.50, 0.0);
    rings = tilted(rings, pivot, -13.0);
    const Part part = loft(rings, 26, headBinder(mesh));
    mesh.wear("Cap", "Hat");
    mesh.add(part, 320, 160, peoplePaint::cap(part.along[8]), wandererPaint::wool);
    std::vector<LoftRing> ball = tilted(
        ellipsoid({0.0, 1.708, 0.004}, {0.0, 0.043, 0.0}, {0.046, 0.0, 0.0}, {0.0, 0.0, 0.046}, 9), pivot, -13.0);
    for (std::size_t ring = 1; ring + 1 < ball.size(); ++ring)
        ball[ring].side *= ring % 2 ? 1.06 : 0.95;
    mesh.add(loft(ball, 12, headBinder(mesh)), 70, 50, wandererPaint::fleece, wandererPaint::wool);
}

} // namespace

void addPeopleNeck(CharacterMesh& mesh)
{
    const auto at = [](double height, double radius) {
        return levelRing({0.0, height, -0.006}, radius, radius, radius);
    };
    const int chest = mesh.rig().index("Chest"), neck = mesh.rig().index("Neck"), head = mesh.rig().index("Head");
    const auto binder = [=](const glm::dvec3& position, const LoftRing&)
    {
        Binding result(chest);
        result.give(glm::smoothstep(1.18, 1.22, position.y), neck);
        return result.give(glm::smoothstep(1.23, 1.30, position.y), head);
    };
    mesh.add(loft({at(1.17, 0.0), at(1.172, 0.060), at(1.20, 0.060), at(1.23, 0.060), at(1.26, 0.064), at(1.30, 0.068),
                   at(1.305, 0.0)},
                  14, binder),
             60, 40, peoplePaint::skin, wandererPaint::skinned);
}

void addPeopleEars(CharacterMesh& mesh)
{
    const glm::dvec3 forward = glm::normalize(glm::dvec3(0.35, 0.0, 0.94));
    const std::vector<LoftRing> ear = ellipsoid({0.206, 1.408, 0.002}, glm::cross(forward, {0.0, 1.0, 0.0}) * -0.018,
                                                {0.0, 0.040, 0.0}, forward * 0.030, 8);
    mesh.addPair(loft(ear, 10, headBinder(mesh)), 44, 40, peoplePaint::skin, wandererPaint::skinned);
}

void addPeopleHeads(CharacterMesh& mesh)
{
    addHair(mesh);
    addBun(mesh);
    addBeard(mesh);
    mesh.wear("Hood", "Hat");
    addWandererHood(mesh, peoplePaint::hood, wandererPaint::fleece);
    addHat(mesh);
    addCap(mesh);
}

} // namespace osgGpuAnimation::scenes
