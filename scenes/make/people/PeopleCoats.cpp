// SPDX-License-Identifier: MIT
#include "PeopleCoats.h"
#include "../wanderer/WandererBinders.h"
#include "../wanderer/WandererBody.h"
#include "../wanderer/WandererGear.h"
#include "../wanderer/WandererPaint.h"
#include "PeoplePaint.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace osgGpuAnimation::scenes
{

namespace
{

/// A ring's copy, `inward` metres smaller, at a height.
LoftRing inside(const LoftRing& ring, double height, double inward)
{
    const double front = glm::length(ring.front);
    LoftRing result = wandererCoatRing(height, ring.side.x - inward, front - inward, front * ring.back - inward);
    result.roundness = ring.roundness;
    return result;
}

/// A skirt that follows each thigh more closely than a short coat does, so that the rear one stays inside.
Binder robeBinder(const Rig& rig)
{
    const Binder coat = coatBinder(rig);
    const int thighs[] = {rig.index("UpperLeg_R"), rig.index("UpperLeg_L")};
    return [=](const glm::dvec3& position, const LoftRing& ring)
    {
        Binding thigh(thighs[0]);
        thigh.give(glm::smoothstep(-0.055, 0.055, position.x), thighs[1]);
        return coat(position, ring).give(1.0 - glm::smoothstep(0.62, 0.78, position.y), thigh);
    };
}

/// The trunk of a coat, with a lining that closes it `depth` metres above the hem. paint: takes the hem's v.
void addTrunk(CharacterMesh& mesh, const std::vector<LoftRing>& outline, const Binder& binder, double depth, int height,
              Painter (*paint)(double))
{
    std::vector<LoftRing> rings = refined(outline, 2);
    const std::size_t last = rings.size() - 1;
    const LoftRing hem = outline.back();
    const double low = hem.center.y - 0.012;
    rings.push_back(inside(hem, low, 0.001));
    rings.push_back(inside(hem, low, 0.012));
    const auto outside = [&](double level)
    { return *std::find_if(rings.begin(), rings.end(), [=](const LoftRing& ring) { return ring.center.y <= level; }); };
    for (double share : {0.25, 0.8})
        rings.push_back(inside(outside(low + share * depth), low + share * depth, 0.020));
    rings.push_back(wandererCoatRing(low + depth, 0.0, 0.0, 0.0));
    const Part part = loft(rings, 26, binder);
    mesh.add(part, 420, height, paint(part.along[last]), wandererPaint::wool);
}

void addCollar(CharacterMesh& mesh)
{
    const auto at = [](double height, double radius) {
        return levelRing({0.0, height, -0.008}, radius, radius * 1.02, radius);
    };
    const std::vector<LoftRing> rings = {at(1.196, 0.108), at(1.214, 0.099), at(1.238, 0.094), at(1.246, 0.088),
                                         at(1.240, 0.081), at(1.215, 0.076), at(1.205, 0.060)};
    const int chest = mesh.rig().index("Chest");
    const int neck = mesh.rig().index("Neck");
    const auto binder = [=](const glm::dvec3& position, const LoftRing&)
    { return Binding(chest).give(glm::smoothstep(1.19, 1.25, position.y) * 0.6, neck); };
    mesh.add(loft(rings, 18, binder), 160, 40, peoplePaint::collar, wandererPaint::wool);
}

std::vector<LoftRing> upTo(double waist)
{
    std::vector<LoftRing> result;
    for (const LoftRing& ring : wandererCoatRings())
        if (ring.center.y > waist) result.push_back(ring);
    return result;
}

void addCoat(CharacterMesh& mesh)
{
    mesh.wear("Coat", "Coat");
    addTrunk(mesh, wandererCoatRings(), coatBinder(mesh.rig()), 0.14, 290, peoplePaint::coat);
    addWandererSleeves(mesh, peoplePaint::sleeve);
    addCollar(mesh);
    mesh.wear("Coat", "Leather");
    addWandererBelt(mesh);
    mesh.wear("Coat", "Fittings");
    addWandererBuckle(mesh);
    addWandererButtons(mesh);
}

/// Wooden toggles, each on two cords.
void addToggles(CharacterMesh& mesh)
{
    for (double height : {1.120, 1.035, 0.950, 0.865})
    {
        const LoftRing coat = wandererCoatAt(height);
        const glm::dvec3 place(0.0, height, coat.center.z + coat.front.z + 0.006);
        const std::vector<LoftRing> toggle =
            ellipsoid(place, {0.024, 0.0, 0.0}, {0.0, 0.0, 0.011}, {0.0, 0.011, 0.0}, 7);
        mesh.add(loft(toggle, 8, coatBinder(mesh.rig())), 34, 34, wandererPaint::leather, wandererPaint::waxed);
    }
}

void addJacket(CharacterMesh& mesh)
{
    std::vector<LoftRing> outline = upTo(0.87);
    for (const auto& [height, side, front, back] : {std::array{0.830, 0.167, 0.142, 0.132},
                                                    {0.785, 0.177, 0.151, 0.144},
                                                    {0.755, 0.178, 0.151, 0.145},
                                                    {0.738, 0.168, 0.142, 0.136},
                                                    {0.722, 0.167, 0.141, 0.135},
                                                    {0.700, 0.171, 0.145, 0.139}})
        outline.push_back(wandererCoatRing(height, side, front, back));
    mesh.wear("Jacket", "Coat");
    addTrunk(mesh, outline, coatBinder(mesh.rig()), 0.075, 230, peoplePaint::jacket);
    addWandererSleeves(mesh, peoplePaint::jacketSleeve);
    addCollar(mesh);
    mesh.wear("Jacket", "Leather");
    addToggles(mesh);
}

void addSash(CharacterMesh& mesh)
{
    const auto band = [](double height, double off)
    {
        const LoftRing ring = wandererCoatAt(height);
        const double front = glm::length(ring.front);
        return levelRing({0.0, height, ring.center.z}, ring.side.x + off, front + off, front * ring.back + off);
    };
    const std::vector<LoftRing> sash = {band(0.925, -0.010), band(0.922, 0.006), band(0.910, 0.011),
                                        band(0.890, 0.009),  band(0.872, 0.012), band(0.850, 0.009),
                                        band(0.838, 0.006),  band(0.834, -0.010)};
    mesh.add(loft(sash, 26, coatBinder(mesh.rig())), 240, 50, peoplePaint::sash, wandererPaint::wool);
}

void addRobe(CharacterMesh& mesh)
{
    std::vector<LoftRing> outline = upTo(0.87);
    for (const auto& [height, side, front, back] : {std::array{0.830, 0.167, 0.141, 0.131},
                                                    {0.760, 0.190, 0.160, 0.156},
                                                    {0.690, 0.211, 0.182, 0.186},
                                                    {0.600, 0.232, 0.208, 0.220},
                                                    {0.500, 0.252, 0.230, 0.248},
                                                    {0.412, 0.266, 0.244, 0.266}})
        outline.push_back(wandererCoatRing(height, side, front, back));
    mesh.wear("Robe", "Coat");
    addTrunk(mesh, outline, robeBinder(mesh.rig()), 0.32, 330, peoplePaint::robe);
    addWandererSleeves(mesh, peoplePaint::robeSleeve);
    addCollar(mesh);
    mesh.wear("Robe", "Scarf");
    addSash(mesh);
}

} // namespace

void addPeopleCoats(CharacterMesh& mesh)
{
    addCoat(mesh);
    addJacket(mesh);
    addRobe(mesh);
}

} // namespace osgGpuAnimation::scenes
