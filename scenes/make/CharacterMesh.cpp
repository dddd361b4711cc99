// SPDX-License-Identifier: MIT
#include "CharacterMesh.h"
#include "AmbientOcclusion.h"

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

void CharacterMesh::wear(const std::string& garment, const std::string& material)
{
    _garment = garment;
    _material = material;
}

void CharacterMesh::add(Part part, int width, int height, const Painter& painter, const Painter& reflection)
{
    part.rect.width = static_cast<int>(std::lround(width * _scale));
    part.rect.height = static_cast<int>(std::lround(height * _scale));
    part.garment = _garment;
    part.material = _material;
    part.painter = painter;
    part.reflection = reflection;
    _parts.push_back(std::move(part));
}

void CharacterMesh::addPair(const Part& part, int width, int height, const Painter& painter, const Painter& reflection)
{
    add(part, width, height, painter, reflection);
    _parts.push_back(mirrored(_parts.back(), _rig));
}

void CharacterMesh::finish()
{
    light();
    allocateRects();
    for (const Part& part : _parts)
        if (part.painted) _atlas.paint(part);
}

void CharacterMesh::light()
{
    const double reach = 0.30; // metres: as far as a limb is from the body
    std::vector<std::vector<Part>> garments;
    for (Part& part : _parts)
    {
        const auto same = [&](const std::vector<Part>& garment) { return garment[0].garment == part.garment; };
        auto found = std::find_if(garments.begin(), garments.end(), same);
        if (found == garments.end()) found = garments.emplace(found);
        found->push_back(std::move(part));
    }
    _parts.clear();
    for (std::size_t garment = 0; garment < garments.size(); ++garment)
    {
        computeLight(garments[garment], garment > 0 ? garments[0] : std::vector<Part>(), reach);
        _parts.insert(_parts.end(), garments[garment].begin(), garments[garment].end());
    }
}

void CharacterMesh::allocateRects()
{
    std::vector<Part*> painted;
    for (Part& part : _parts)
        if (part.painted) painted.push_back(&part);
    std::stable_sort(painted.begin(), painted.end(),
                     [](const Part* a, const Part* b) { return a->rect.height > b->rect.height; });
    for (Part* part : painted)
        part->rect = _atlas.allocate(part->rect.width, part->rect.height);
    for (std::size_t i = 1; i < _parts.size(); ++i)
        if (!_parts[i].painted) _parts[i].rect = _parts[i - 1].rect; // a mirror image follows its original
}

std::vector<std::pair<std::string, std::string>> CharacterMesh::primitives() const
{
    std::vector<std::pair<std::string, std::string>> result;
    for (const Part& part : _parts)
        if (std::find(result.begin(), result.end(), std::pair(part.garment, part.material)) == result.end())
            result.emplace_back(part.garment, part.material);
    return result;
}

PrimitiveArrays CharacterMesh::arrays(const std::string& garment, const std::string& material) const
{
    PrimitiveArrays arrays;
    for (const Part& part : _parts)
    {
        if (part.garment != garment || part.material != material) continue;
        appendPart(arrays, part);
        appendBindings(arrays, part);
    }
    return arrays;
}

void appendPart(PrimitiveArrays& arrays, const Part& part)
{
    const auto first = static_cast<std::uint32_t>(arrays.positions.size());
    arrays.positions.insert(arrays.positions.end(), part.positions.begin(), part.positions.end());
    arrays.normals.insert(arrays.normals.end(), part.normals.begin(), part.normals.end());
    for (int row = 0; part.rect.width > 0 && row < part.rows; ++row)
        for (int column = 0; column < part.columns; ++column)
            arrays.textureCoordinates.push_back(part.textureCoordinate(row, column));
    for (const auto& triangle : part.triangles())
        for (int vertex : triangle)
            arrays.indices.push_back(first + vertex);
}

void appendBindings(PrimitiveArrays& arrays, const Part& part)
{
    for (const Binding& binding : part.bindings)
    {
        const std::array<JointWeight, 4> entries = binding.quantised();
        std::array<std::uint8_t, 4> joints;
        std::array<double, 4> weights;
        for (int place = 0; place < 4; ++place)
        {
            joints[place] = static_cast<std::uint8_t>(entries[place].joint);
            weights[place] = entries[place].weight;
        }
        arrays.joints.push_back(joints);
        arrays.weights.push_back(weights);
    }
}

} // namespace osgGpuAnimation::scenes
