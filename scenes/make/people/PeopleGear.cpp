// SPDX-License-Identifier: MIT
#include "PeopleGear.h"
#include "../wanderer/WandererBinders.h"
#include "../wanderer/WandererGear.h"
#include "../wanderer/WandererPaint.h"
#include "PeoplePaint.h"

#include <glm/geometric.hpp>

namespace osgGpuAnimation::scenes
{

namespace
{

void addSack(CharacterMesh& mesh)
{
    const auto section = [](double height, double width, double out, double depth)
    {
        LoftRing ring;
        ring.center = {0.0, height, -out};
        ring.side = {width, 0.0, 0.0};
        ring.front = {0.0, 0.0, depth};
        ring.roundness = 0.6;
        return ring;
    };
    const std::vector<LoftRing> sack = {section(0.885, 0.0, 0.190, 0.0),     section(0.885, 0.096, 0.190, 0.048),
                                        section(0.905, 0.122, 0.196, 0.068), section(0.970, 0.132, 0.200, 0.074),
                                        section(1.035, 0.130, 0.198, 0.072), section(1.038, 0.138, 0.198, 0.080),
                                        section(1.085, 0.134, 0.194, 0.074), section(1.118, 0.118, 0.186, 0.058),
                                        section(1.130, 0.090, 0.182, 0.036), section(1.132, 0.0, 0.182, 0.0)};
    mesh.wear("Pack", "Pack");
    mesh.add(loft(sack, 20, rigidBinder(mesh.rig().index("Chest"))), 240, 150, peoplePaint::pack, wandererPaint::waxed);
}

/// A blanket, rolled up on top of the sack.
void addRoll(CharacterMesh& mesh)
{
    const auto disc = [](double x, double radius)
    {
        LoftRing ring;
        ring.center = {x, 1.172, -0.196};
        ring.side = {0.0, radius, 0.0};
        ring.front = {0.0, 0.0, radius};
        return ring;
    };
    const std::vector<LoftRing> roll = {
        disc(-0.176, 0.0),   disc(-0.168, 0.030), disc(-0.170, 0.044), disc(-0.160, 0.050), disc(-0.088, 0.051),
        disc(-0.074, 0.045), disc(-0.060, 0.051), disc(0.060, 0.051),  disc(0.074, 0.045),  disc(0.088, 0.051),
        disc(0.160, 0.050),  disc(0.170, 0.044),  disc(0.168, 0.030),  disc(0.176, 0.0)};
    mesh.wear("Pack", "Scarf");
    mesh.add(loft(roll, 14, rigidBinder(mesh.rig().index("Chest"))), 100, 150, peoplePaint::blanket,
             wandererPaint::wool);
}

/// From the sack over the left shoulder and below the arm back to it.
void addPackStrap(CharacterMesh& mesh)
{
    const std::vector<glm::dvec3> places = {{0.080, 1.090, -0.130}, {0.082, 1.150, -0.122}, {0.086, 1.196, -0.096},
                                            {0.090, 1.222, -0.050}, {0.092, 1.226, 0.000},  {0.094, 1.204, 0.054},
                                            {0.098, 1.160, 0.092},  {0.104, 1.100, 0.108},  {0.114, 1.040, 0.106},
                                            {0.132, 0.985, 0.090},  {0.154, 0.950, 0.052},  {0.164, 0.930, 0.000},
                                            {0.150, 0.915, -0.060}, {0.118, 0.910, -0.104}, {0.090, 0.915, -0.140}};
    const glm::dvec3 chest(0.05, 1.06, -0.01);
    std::vector<LoftRing> rings;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        const glm::dvec3 along = places[std::min(i + 1, places.size() - 1)] - places[i > 0 ? i - 1 : 0];
        LoftRing ring = ringAcross(places[i], along, places[i] - chest, 0.019, 0.008);
        ring.roundness = 0.6;
        rings.push_back(ring);
    }
    mesh.wear("Pack", "Leather");
    mesh.addPair(loft(refined(rings, 2), 6, coatBinder(mesh.rig())), 40, 190, wandererPaint::leather,
                 wandererPaint::waxed);
}

} // namespace

void addPeopleGear(CharacterMesh& mesh)
{
    mesh.wear("Scarf", "Scarf");
    addWandererScarf(mesh, peoplePaint::scarf, peoplePaint::scarfTail);
    mesh.wear("Bag", "Leather");
    addWandererBag(mesh);
    addSack(mesh);
    addRoll(mesh);
    addPackStrap(mesh);
}

} // namespace osgGpuAnimation::scenes
