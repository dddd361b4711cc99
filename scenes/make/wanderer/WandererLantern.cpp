// SPDX-License-Identifier: MIT
#include "WandererLantern.h"
#include "../CharacterMesh.h"
#include "WandererBinders.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

struct Turning
{
    double height; ///< metres
    double radius; ///< metres
};

/// A turned body around the Y axis, every edge hard.
Part turned(const std::vector<Turning>& outline)
{
    std::vector<LoftRing> rings;
    for (const auto& [height, radius] : outline)
        for (int side = 0; side < 2; ++side)
            rings.push_back(levelRing({0.0, height, 0.0}, radius, radius, radius));
    return loft(rings, 12, rigidBinder(0));
}

Part lanternHandle()
{
    const double radius = 0.066;
    std::vector<LoftRing> rings;
    for (int step = 0; step <= 12; ++step)
    {
        const double angle = glm::pi<double>() * (step / 12.0 * 1.24 - 0.12);
        const glm::dvec3 outward(0.0, std::sin(angle), std::cos(angle));
        const glm::dvec3 along(0.0, std::cos(angle), -std::sin(angle));
        rings.push_back(ringAcross(glm::dvec3(0.0, -0.066, 0.0) + outward * radius, along, outward, 0.006, 0.006));
    }
    return loft(rings, 6, rigidBinder(0));
}

Part bar(double angle)
{
    const glm::dvec3 outward(std::sin(angle), 0.0, std::cos(angle));
    std::vector<LoftRing> rings;
    for (const auto& [height, radius] : {std::pair{-0.148, 0.056}, {-0.200, 0.063}, {-0.255, 0.056}})
        rings.push_back(
            ringAcross(outward * radius + glm::dvec3(0.0, height, 0.0), {0.0, -1.0, 0.0}, outward, 0.006, 0.006));
    return loft(refined(rings, 2), 5, rigidBinder(0));
}

tinygltf::Material material(const std::string& name, const std::vector<double>& colour, double metallic,
                            double roughness)
{
    tinygltf::Material result;
    result.name = name;
    result.pbrMetallicRoughness.baseColorFactor = colour;
    result.pbrMetallicRoughness.metallicFactor = metallic;
    result.pbrMetallicRoughness.roughnessFactor = roughness;
    return result;
}

} // namespace

int addWandererLantern(GltfDocument& document)
{
    const int mesh = document.addMesh("Lantern");

    PrimitiveArrays frame;
    appendPart(frame, lanternHandle());
    appendPart(frame, turned({{-0.062, 0.0}, {-0.062, 0.012}, {-0.080, 0.016}, {-0.092, 0.010}}));
    appendPart(
        frame,
        turned({{-0.088, 0.0}, {-0.088, 0.014}, {-0.104, 0.034}, {-0.136, 0.068}, {-0.150, 0.066}, {-0.150, 0.0}}));
    appendPart(
        frame,
        turned({{-0.250, 0.0}, {-0.250, 0.060}, {-0.262, 0.068}, {-0.284, 0.068}, {-0.292, 0.058}, {-0.292, 0.0}}));
    for (int quarter = 0; quarter < 4; ++quarter)
        appendPart(frame, bar(glm::half_pi<double>() * (quarter + 0.5)));
    document.addPrimitive(mesh, frame, document.addMaterial(material("Brass", {0.86, 0.60, 0.26, 1.0}, 1.0, 0.28)));

    PrimitiveArrays glass;
    std::vector<LoftRing> rings;
    for (const auto& [height, radius] : {Turning{-0.148, 0.0},
                                         {-0.148, 0.044},
                                         {-0.170, 0.052},
                                         {-0.200, 0.055},
                                         {-0.230, 0.052},
                                         {-0.252, 0.044},
                                         {-0.252, 0.0}})
        rings.push_back(levelRing({0.0, height, 0.0}, radius, radius, radius));
    appendPart(glass, loft(rings, 12, rigidBinder(0)));
    tinygltf::Material glow = material("Glow", {0.95, 0.56, 0.14, 1.0}, 0.0, 0.15);
    glow.emissiveFactor = {1.0, 0.50, 0.09};
    glow.extensions["KHR_materials_emissive_strength"] =
        tinygltf::Value(tinygltf::Value::Object{{"emissiveStrength", tinygltf::Value(1.6)}});
    document.addPrimitive(mesh, glass, document.addMaterial(glow));
    return mesh;
}

} // namespace osgGpuAnimation::scenes
