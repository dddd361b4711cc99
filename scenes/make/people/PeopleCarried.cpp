// SPDX-License-Identifier: MIT
#include "PeopleCarried.h"
#include "../CharacterMesh.h"
#include "../wanderer/WandererBinders.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

int addMaterial(GltfDocument& document, const std::string& name, const std::vector<double>& colour, double roughness)
{
    tinygltf::Material result;
    result.name = name;
    result.pbrMetallicRoughness.baseColorFactor = colour;
    result.pbrMetallicRoughness.metallicFactor = 0.0;
    result.pbrMetallicRoughness.roughnessFactor = roughness;
    return document.addMaterial(result);
}

/// A rod along places, thick as the radii say.
Part rod(const std::vector<glm::dvec3>& places, const std::vector<double>& radii, const glm::dvec3& frontward,
         int segments)
{
    std::vector<LoftRing> rings;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        const glm::dvec3 along = places[std::min(i + 1, places.size() - 1)] - places[i > 0 ? i - 1 : 0];
        rings.push_back(ringAcross(places[i], along, frontward, radii[i], radii[i]));
    }
    rings.insert(rings.begin(), rings.front());
    rings.front().side = rings.front().front = glm::dvec3(0.0);
    rings.push_back(rings.back());
    rings.back().side = rings.back().front = glm::dvec3(0.0);
    return loft(rings, segments, rigidBinder(0));
}

Part handle()
{
    std::vector<glm::dvec3> places;
    for (int step = 0; step <= 14; ++step)
    {
        const double angle = glm::pi<double>() * step / 14.0;
        places.emplace_back(0.0, -0.155 + 0.155 * std::sin(angle), 0.118 * std::cos(angle));
    }
    return rod(places, std::vector<double>(places.size(), 0.009), {1.0, 0.0, 0.0}, 7);
}

/// Woven: the wall swells and narrows from course to course.
Part bowl()
{
    std::vector<LoftRing> rings = {levelRing({0.0, -0.262, 0.0}, 0.0, 0.0, 0.0)};
    const auto ring = [&](double height, double radius) {
        rings.push_back(levelRing({0.0, height, 0.0}, radius * 0.82, radius, radius));
    };
    ring(-0.262, 0.082);
    ring(-0.262, 0.082);
    for (int course = 0; course < 5; ++course)
    {
        const double low = -0.258 + 0.020 * course;
        const double radius = 0.088 + 0.007 * course;
        ring(low, radius - 0.004);
        ring(low + 0.010, radius + 0.004);
    }
    ring(-0.158, 0.117);
    ring(-0.150, 0.128);
    ring(-0.140, 0.126);
    ring(-0.136, 0.116);
    ring(-0.144, 0.108);
    ring(-0.170, 0.104);
    ring(-0.170, 0.0);
    return loft(rings, 18, rigidBinder(0));
}

/// What is in the basket: apples.
Part apple(const glm::dvec3& place)
{
    const double radius = 0.040;
    return loft(ellipsoid(place, {0.0, radius * 0.92, 0.0}, {radius, 0.0, 0.0}, {0.0, 0.0, radius}, 8), 10,
                rigidBinder(0));
}

} // namespace

int addPeopleBasket(GltfDocument& document)
{
    const int mesh = document.addMesh("Basket");
    PrimitiveArrays wicker;
    appendPart(wicker, bowl());
    appendPart(wicker, handle());
    document.addPrimitive(mesh, wicker, addMaterial(document, "Wicker", {0.47, 0.29, 0.12, 1.0}, 0.75));
    PrimitiveArrays apples;
    for (const glm::dvec3& place :
         {glm::dvec3(0.035, -0.150, 0.050), {-0.040, -0.152, 0.030}, {0.032, -0.152, -0.036}, {-0.032, -0.150, -0.052}})
        appendPart(apples, apple(place));
    document.addPrimitive(mesh, apples, addMaterial(document, "Apples", {0.52, 0.10, 0.05, 1.0}, 0.35));
    return mesh;
}

int addPeopleStaff(GltfDocument& document)
{
    std::vector<glm::dvec3> places;
    std::vector<double> radii;
    for (const auto& [x, y, z, radius] : {std::array{0.004, -0.768, 0.004, 0.012},
                                          {-0.005, -0.600, 0.000, 0.015},
                                          {0.004, -0.350, -0.004, 0.016},
                                          {0.000, -0.120, 0.000, 0.016},
                                          {0.000, 0.120, 0.000, 0.017},
                                          {-0.006, 0.280, 0.004, 0.018},
                                          {0.000, 0.400, -0.004, 0.020},
                                          {0.004, 0.440, -0.006, 0.032},
                                          {0.006, 0.472, -0.004, 0.038},
                                          {0.004, 0.502, 0.000, 0.033},
                                          {0.002, 0.520, 0.002, 0.018}})
    {
        places.emplace_back(x, y, z);
        radii.push_back(radius);
    }
    const int mesh = document.addMesh("Staff");
    PrimitiveArrays wood;
    appendPart(wood, rod(places, radii, {1.0, 0.0, 0.0}, 8));
    document.addPrimitive(mesh, wood, addMaterial(document, "Wood", {0.23, 0.13, 0.065, 1.0}, 0.6));
    return mesh;
}

} // namespace osgGpuAnimation::scenes
