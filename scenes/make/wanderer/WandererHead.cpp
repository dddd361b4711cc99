// SPDX-License-Identifier: MIT
#include "WandererHead.h"
#include "../ChainBinding.h"
#include "WandererBinders.h"
#include "WandererPaint.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

const glm::dvec3 wandererFaceCenter(0.0, 1.435, 0.015);
const glm::dvec3 wandererFaceHalf(0.196, 0.182, 0.178);

namespace
{

/// A place on the face, by its height and sideward distance from the centre.
glm::dvec3 onFace(double x, double y)
{
    const double flat =
        (x * x) / (wandererFaceHalf.x * wandererFaceHalf.x) + (y * y) / (wandererFaceHalf.y * wandererFaceHalf.y);
    return wandererFaceCenter + glm::dvec3(x, y, wandererFaceHalf.z * std::sqrt(std::max(0.0, 1.0 - flat)));
}

} // namespace

void addWandererFace(CharacterMesh& mesh)
{
    std::vector<LoftRing> rings = ellipsoid(wandererFaceCenter, {0.0, wandererFaceHalf.y, 0.0},
                                            {wandererFaceHalf.x, 0.0, 0.0}, {0.0, 0.0, wandererFaceHalf.z}, 15);
    for (LoftRing& ring : rings)
    {
        // Full cheeks: the lower half is wider than an ellipsoid's.
        const double height = (ring.center.y - wandererFaceCenter.y) / wandererFaceHalf.y;
        ring.side *= 1.0 + 0.08 * std::max(0.0, 1.0 - std::abs(height + 0.45) / 0.55);
    }
    mesh.add(loft(rings, 22, rigidBinder(mesh.rig().index("Head"))), 448, 296, wandererPaint::face,
             wandererPaint::skinned);

    const glm::dvec3 nose = onFace(0.0, -0.045);
    const std::vector<LoftRing> nub = ellipsoid(nose, {0.0, 0.014, 0.0}, {0.019, 0.0, 0.0}, {0.0, 0.0, 0.016}, 6);
    mesh.add(loft(nub, 8, rigidBinder(mesh.rig().index("Head"))), 40, 40, wandererPaint::face, wandererPaint::skinned);
}

void addWandererEyes(CharacterMesh& mesh)
{
    const glm::dvec3 place = onFace(0.078, -0.012);
    const glm::dvec3 outward = glm::normalize((place - wandererFaceCenter) / (wandererFaceHalf * wandererFaceHalf));
    const glm::dvec3 side = glm::normalize(glm::cross({0.0, 1.0, 0.0}, outward));
    const glm::dvec3 up = glm::cross(outward, side);
    const std::vector<LoftRing> ball = ellipsoid(place - outward * 0.004, outward * 0.013, side * 0.029, up * 0.042, 7);
    // Both are painted, not mirrored: the light falls into both eyes from the same side.
    for (double sign : {1.0, -1.0})
    {
        std::vector<LoftRing> rings = ball;
        for (LoftRing& ring : rings)
        {
            const glm::dvec3 mirror(sign, 1.0, 1.0);
            ring.center *= mirror;
            ring.front *= mirror;
            ring.side *= glm::dvec3(1.0, 1.0, sign);
        }
        mesh.add(loft(rings, 12, rigidBinder(mesh.rig().index("Head"))), 72, 72, wandererPaint::eye,
                 wandererPaint::wetEye);
    }
}

namespace
{

/// A strand of hair: from the hood's rim down over the forehead.
void addStrand(CharacterMesh& mesh, const Painter& painter, const glm::dvec3& root, const glm::dvec3& bend,
               const glm::dvec3& tip, double width)
{
    std::vector<LoftRing> rings;
    for (int step = 0; step <= 6; ++step)
    {
        const double t = step / 6.0;
        const glm::dvec3 center = root * ((1.0 - t) * (1.0 - t)) + bend * (2.0 * t * (1.0 - t)) + tip * (t * t);
        const glm::dvec3 along = (bend - root) * (1.0 - t) + (tip - bend) * t;
        const bool end = step == 0 || step == 6;
        const double swell = end ? 0.0 : std::pow(1.0 - t, 0.55) * (1.0 + 0.9 * t);
        rings.push_back(ringAcross(center, along, center - wandererFaceCenter, width * swell, 0.018 * swell));
    }
    mesh.add(loft(rings, 7, rigidBinder(mesh.rig().index("Head"))), 44, 60, painter, wandererPaint::combed);
}

} // namespace

void addWandererFringe(CharacterMesh& mesh, const Painter& painter)
{
    const auto out = [](double x, double y, double off) { return onFace(x, y) + glm::dvec3(0.0, 0.0, off); };
    addStrand(mesh, painter, out(0.035, 0.175, 0.01), out(0.00, 0.135, 0.035), out(-0.064, 0.064, 0.012), 0.044);
    addStrand(mesh, painter, out(0.045, 0.172, 0.01), out(0.06, 0.130, 0.030), out(0.046, 0.068, 0.012), 0.038);
    addStrand(mesh, painter, out(0.080, 0.160, 0.00), out(0.12, 0.110, 0.030), out(0.140, 0.048, 0.016), 0.036);
    addStrand(mesh, painter, out(-0.045, 0.172, 0.00), out(-0.10, 0.130, 0.030), out(-0.146, 0.052, 0.016), 0.038);
}

namespace
{

/// A ring of the hood: an upright ellipse whose plane leans back by `lean` degrees.
LoftRing hoodRing(double y, double z, double side, double up, double down, double lean)
{
    const double angle = glm::radians(lean);
    LoftRing ring;
    ring.center = {0.0, y, z};
    ring.side = {side, 0.0, 0.0};
    ring.front = glm::dvec3(0.0, std::cos(angle), -std::sin(angle)) * up;
    ring.back = up > 0.0 ? down / up : 1.0;
    return ring;
}

Binder hoodBinder(const Rig& rig)
{
    ChainBinding hood(rig.index("Head"));
    hood.then(rig.index("HoodTip1"), {0.0, 1.52, -0.22}, {0.0, 0.15, -1.0}, 0.075)
        .then(rig.index("HoodTip2"), {0.0, 1.54, -0.335}, {0.0, -0.4, -1.0}, 0.055);
    return [=](const glm::dvec3&, const LoftRing& ring) { return hood.at(ring.center); };
}

} // namespace

void addWandererHood(CharacterMesh& mesh, const Painter& hood, const Painter& pompom)
{
    const std::vector<LoftRing> rim = {
        hoodRing(1.435, 0.000, 0.000, 0.000, 0.000, 0.0), hoodRing(1.435, 0.020, 0.198, 0.186, 0.186, 0.0),
        hoodRing(1.437, 0.090, 0.196, 0.185, 0.182, 2.0), hoodRing(1.440, 0.128, 0.192, 0.182, 0.178, 4.0),
        hoodRing(1.441, 0.145, 0.203, 0.192, 0.186, 4.0), hoodRing(1.441, 0.142, 0.222, 0.212, 0.200, 4.0),
        hoodRing(1.440, 0.118, 0.231, 0.222, 0.208, 4.0), hoodRing(1.440, 0.104, 0.228, 0.219, 0.205, 4.0)};
    const std::vector<LoftRing> dome = {
        hoodRing(1.440, 0.104, 0.228, 0.219, 0.205, 4.0),    hoodRing(1.440, 0.050, 0.244, 0.242, 0.222, 2.0),
        hoodRing(1.440, -0.020, 0.249, 0.254, 0.232, -2.0),  hoodRing(1.444, -0.090, 0.234, 0.246, 0.228, -8.0),
        hoodRing(1.458, -0.155, 0.192, 0.206, 0.206, -12.0), hoodRing(1.486, -0.210, 0.138, 0.142, 0.158, -12.0)};
    const std::vector<LoftRing> tip = {
        hoodRing(1.518, -0.262, 0.094, 0.090, 0.104, -8.0), hoodRing(1.536, -0.318, 0.066, 0.062, 0.068, 6.0),
        hoodRing(1.524, -0.372, 0.046, 0.044, 0.046, 35.0), hoodRing(1.490, -0.412, 0.030, 0.029, 0.030, 55.0),
        hoodRing(1.452, -0.436, 0.014, 0.014, 0.014, 62.0), hoodRing(1.440, -0.442, 0.000, 0.000, 0.000, 62.0)};
    std::vector<LoftRing> rings = rim;
    const std::vector<LoftRing> shell = refined(dome, 2);
    rings.insert(rings.end(), shell.begin() + 1, shell.end());
    rings.insert(rings.end(), tip.begin(), tip.end());
    mesh.add(loft(rings, 24, hoodBinder(mesh.rig())), 432, 296, hood, wandererPaint::wool);

    std::vector<LoftRing> ball =
        ellipsoid({0.0, 1.432, -0.446}, {0.0, 0.040, 0.014}, {0.044, 0.0, 0.0}, {0.0, -0.014, 0.042}, 9);
    for (std::size_t ring = 1; ring + 1 < ball.size(); ++ring)
        ball[ring].side *= ring % 2 ? 1.06 : 0.95;
    mesh.add(loft(ball, 12, rigidBinder(mesh.rig().index("HoodTip2"))), 70, 50, pompom, wandererPaint::wool);
}

void addWandererHead(CharacterMesh& mesh)
{
    addWandererFace(mesh);
    addWandererHood(mesh, wandererPaint::hood, wandererPaint::fleece);
    addWandererEyes(mesh);
    addWandererFringe(mesh, wandererPaint::hair);
}

} // namespace osgGpuAnimation::scenes
