// SPDX-License-Identifier: MIT
#include "MaterialBalls.h"
#include "GltfDocument.h"
#include "PngEncoder.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

constexpr int columns = 6;
constexpr double apart = 0.25;  ///< metres from one ball's middle to the next
constexpr double radius = 0.11; ///< metres

/// A ball around the origin with texture coordinates and tangents.
PrimitiveArrays ball()
{
    constexpr int around = 48, along = 24;
    PrimitiveArrays arrays;
    for (int row = 0; row <= along; ++row)
        for (int column = 0; column <= around; ++column)
        {
            const double latitude = glm::pi<double>() * row / along;
            const double angle = glm::two_pi<double>() * (column % around) / around;
            const glm::dvec3 normal(std::sin(latitude) * std::sin(angle), std::cos(latitude),
                                    std::sin(latitude) * std::cos(angle));
            arrays.positions.push_back(normal * radius);
            arrays.normals.push_back(glm::normalize(normal));
            arrays.tangents.emplace_back(std::cos(angle), 0.0, -std::sin(angle), 1.0);
            arrays.textureCoordinates.emplace_back(static_cast<double>(column) / around,
                                                   static_cast<double>(row) / along);
        }
    for (int row = 0; row < along; ++row)
        for (int column = 0; column < around; ++column)
        {
            const auto corner = static_cast<std::uint32_t>(row * (around + 1) + column);
            const std::uint32_t below = corner + around + 1;
            if (row > 0) arrays.indices.insert(arrays.indices.end(), {corner, below, corner + 1});
            if (row + 1 < along) arrays.indices.insert(arrays.indices.end(), {corner + 1, below, below + 1});
        }
    return arrays;
}

/// A normal map of round knobs, 8 around and 4 from pole to pole.
std::vector<std::uint8_t> knobs()
{
    constexpr int width = 256, height = 128, knob = 32;
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            glm::dvec3 normal(0.0, 0.0, 1.0);
            const double dx = (x % knob + 0.5) / knob * 2.0 - 1.0;
            const double dy = 1.0 - (y % knob + 0.5) / knob * 2.0;
            const double distance = std::hypot(dx, dy);
            if (distance < 0.85)
                normal = glm::normalize(glm::dvec3(dx, dy, 0.85 / 0.9) * glm::dvec3(0.9 / 0.85, 0.9 / 0.85, 1.0));
            for (int axis = 0; axis < 3; ++axis)
                pixels.push_back(static_cast<std::uint8_t>(std::lround((normal[axis] * 0.5 + 0.5) * 255.0)));
        }
    return encodePng(pixels, width, height);
}

tinygltf::Material material(const std::string& name, const glm::dvec3& colour, double metallic, double roughness)
{
    tinygltf::Material result;
    result.name = name;
    result.pbrMetallicRoughness.baseColorFactor = {colour.x, colour.y, colour.z, 1.0};
    result.pbrMetallicRoughness.metallicFactor = metallic;
    result.pbrMetallicRoughness.roughnessFactor = roughness;
    return result;
}

void extend(tinygltf::Material& material, const std::string& extension, const tinygltf::Value::Object& members)
{
    material.extensions[extension] = tinygltf::Value(members);
}

/// Clearcoat, sheen, emission, normal map, glass, and a coated metal with a normal map.
std::vector<tinygltf::Material> specialMaterials(int normalMap)
{
    tinygltf::Material coated = material("Clearcoat", {0.45, 0.01, 0.02}, 0.0, 0.6);
    extend(coated, "KHR_materials_clearcoat",
           {{"clearcoatFactor", tinygltf::Value(1.0)}, {"clearcoatRoughnessFactor", tinygltf::Value(0.03)}});

    tinygltf::Material velvet = material("Sheen", {0.10, 0.01, 0.16}, 0.0, 0.9);
    const tinygltf::Value::Array lilac = {tinygltf::Value(0.75), tinygltf::Value(0.45), tinygltf::Value(0.9)};
    extend(velvet, "KHR_materials_sheen",
           {{"sheenColorFactor", tinygltf::Value(lilac)}, {"sheenRoughnessFactor", tinygltf::Value(0.35)}});

    tinygltf::Material lamp = material("Emission", {0.05, 0.05, 0.05}, 0.0, 0.4);
    lamp.emissiveFactor = {1.0, 0.42, 0.06};
    extend(lamp, "KHR_materials_emissive_strength", {{"emissiveStrength", tinygltf::Value(1.5)}});

    tinygltf::Material knobbed = material("NormalMap", {0.05, 0.25, 0.42}, 0.0, 0.3);
    knobbed.normalTexture.index = normalMap;

    tinygltf::Material glass = material("Glass", {0.86, 0.96, 0.92}, 0.0, 0.02);
    extend(glass, "KHR_materials_transmission", {{"transmissionFactor", tinygltf::Value(0.9)}});

    tinygltf::Material beaten = material("BeatenCopper", {0.90, 0.46, 0.32}, 1.0, 0.25);
    beaten.normalTexture.index = normalMap;
    return {coated, velvet, lamp, knobbed, glass, beaten};
}

/// The panel swings by 35 degrees to both sides, in 12 seconds.
void addSwing(GltfDocument& document, int node)
{
    constexpr int steps = 24;
    std::vector<double> times;
    std::vector<glm::dquat> rotations;
    for (int step = 0; step <= steps; ++step)
    {
        times.push_back(0.5 * step);
        const double angle = glm::radians(35.0) * std::sin(glm::two_pi<double>() * (step % steps) / steps);
        rotations.push_back(glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0)));
    }
    document.addRotations(document.addAnimation("Swing"), node, document.addTimes(times), rotations);
}

} // namespace

void writeMaterialBalls(const std::string& path)
{
    GltfDocument document("MaterialBalls");
    const int panel = document.addNode("Panel", -1);
    PrimitiveArrays arrays = ball();
    std::vector<tinygltf::Material> special = specialMaterials(document.addTexture("Knobs", knobs(), true));

    int mapped = -1; // the first mesh with texture coordinates, and the first without: others share their vertices
    int plain = -1;
    const auto add = [&](const tinygltf::Material& look, int row, int column)
    {
        const bool hasMap = look.normalTexture.index >= 0;
        if (!hasMap) arrays.tangents.clear();
        if (!hasMap) arrays.textureCoordinates.clear();
        int& first = hasMap ? mapped : plain;
        const int number = document.addMaterial(look);
        int mesh = first;
        if (first < 0)
            document.addPrimitive(mesh = first = document.addMesh(look.name), arrays, number);
        else
            mesh = document.addMeshLike(look.name, first, number);
        const glm::dvec3 place(apart * (column - 0.5 * (columns - 1)), apart * (3 - row) + radius, 0.0);
        document.node(document.addNode(look.name, panel, place)).mesh = mesh;
    };
    for (int column : {3, 5, 0, 1, 2, 4}) // those with maps first
        add(special[column], 3, column);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < columns; ++column)
        {
            const double metallic = 1.0 - 0.5 * row;
            const double roughness = std::max(0.05, static_cast<double>(column) / (columns - 1));
            add(material("Metallic" + std::to_string(50 * (2 - row)) + "Roughness" + std::to_string(20 * column),
                         {0.95, 0.62, 0.22}, metallic, roughness),
                row, column);
        }
    addSwing(document, panel);
    document.write(path);
}

} // namespace osgGpuAnimation::scenes
