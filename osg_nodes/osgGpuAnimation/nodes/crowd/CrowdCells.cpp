// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/crowd/CrowdCells.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr float radiiOfFirstEdge = 16.0f;
constexpr std::size_t fewInCell = 8;    ///< fewer on average: the cells become larger
constexpr std::size_t manyInCell = 256; ///< more on average: the cells become smaller

enum class Side
{
    Outside,
    Across,
    Inside
};

/// The side of all planes on which spheres are, from the box of their centres and their largest radius.
Side sideOf(const std::vector<glm::vec4>& planes, const glm::vec3& min, const glm::vec3& max, float radius)
{
    const glm::vec3 centre = 0.5f * (min + max), half = 0.5f * (max - min);
    Side side = Side::Inside;
    for (const glm::vec4& plane : planes)
    {
        const glm::vec3 normal(plane);
        const float distance = glm::dot(normal, centre) + plane.w;
        const float reach = glm::dot(glm::abs(normal), half);
        if (distance + reach < -radius) return Side::Outside;
        if (!(distance - reach >= 0.0f)) side = Side::Across;
    }
    return side;
}

bool isSeen(const std::vector<glm::vec4>& planes, const glm::vec4& sphere)
{
    bool isSeen = sphere.w >= 0.0f;
    for (const glm::vec4& plane : planes)
        isSeen = isSeen && plane.x * sphere.x + plane.y * sphere.y + plane.z * sphere.z + plane.w >= -sphere.w;
    return isSeen;
}

} // namespace

std::size_t CrowdCells::KeyHash::operator()(const Key& key) const
{
    std::uint64_t hash = 0;
    for (const std::int32_t coordinate : key)
        hash = (hash ^ static_cast<std::uint32_t>(coordinate)) * 0x9E3779B97F4A7C15u;
    return static_cast<std::size_t>(hash ^ hash >> 32);
}

/// Beyond the largest coordinate, cells have no end.
CrowdCells::Key CrowdCells::keyOf(const glm::vec4& sphere) const
{
    constexpr float largest = 1 << 30;
    Key key;
    for (int axis = 0; axis < 3; ++axis)
        key[static_cast<std::size_t>(axis)] =
            static_cast<std::int32_t>(std::floor(std::min(std::max(sphere[axis] / _edge, -largest), largest)));
    return key;
}

CrowdCells::CrowdCells(const CrowdCells& other)
    : _edge(other._edge), _spheres(other._spheres), _places(other._places.size())
{
    for (std::size_t index = 0; index < _spheres.size(); ++index)
        put(index);
}

void CrowdCells::Cell::contain(const glm::vec4& sphere)
{
    min = glm::min(min, glm::vec3(sphere));
    max = glm::max(max, glm::vec3(sphere));
    radius = std::max(radius, sphere.w);
    hasUnseen = hasUnseen || !(sphere.w >= 0.0f);
}

void CrowdCells::put(std::size_t index)
{
    const Key key = keyOf(_spheres[index]);
    Cell& cell = _cells[key];
    cell.key = key;
    cell.contain(_spheres[index]);
    _places[index] = {&cell, static_cast<std::uint32_t>(cell.indices.size())};
    cell.indices.push_back(static_cast<std::uint32_t>(index));
}

void CrowdCells::takeOut(std::size_t index)
{
    const auto [cell, position] = _places[index];
    cell->indices[position] = cell->indices.back();
    _places[cell->indices[position]].position = position;
    cell->indices.pop_back();
    if (cell->indices.empty()) _cells.erase(Key(cell->key));
}

/// Cells of another size if the present ones have too few or too many instances on average.
void CrowdCells::adaptEdge(const Cell& used)
{
    const std::size_t count = _spheres.size(), cells = _cells.size();
    const bool isSparse = used.indices.size() == 1 && cells > 64 && count < fewInCell * cells && _edge < 1e30f;
    const bool isDense = count > manyInCell * cells && _edge > 4.0f * used.radius && _edge > 1e-30f;
    if (!isSparse && !isDense) return;
    _edge *= isSparse ? 2.0f : 0.5f;
    _cells.clear();
    for (std::size_t index = 0; index < count; ++index)
        put(index);
}

void CrowdCells::add(const glm::vec4& sphere)
{
    if (_edge == 0.0f) _edge = sphere.w > 0.0f ? std::min(radiiOfFirstEdge * sphere.w, 1e30f) : 1.0f;
    _spheres.push_back(sphere);
    _places.emplace_back();
    put(_spheres.size() - 1);
    adaptEdge(*_places.back().cell);
}

void CrowdCells::remove(std::size_t index)
{
    takeOut(index);
    if (index + 1 != _spheres.size())
    {
        _spheres[index] = _spheres.back();
        _places[index] = _places.back();
        _places[index].cell->indices[_places[index].position] = static_cast<std::uint32_t>(index);
    }
    _spheres.pop_back();
    _places.pop_back();
}

void CrowdCells::move(std::size_t index, const glm::vec4& sphere)
{
    _spheres[index] = sphere;
    if (keyOf(sphere) == _places[index].cell->key) return _places[index].cell->contain(sphere);
    takeOut(index);
    put(index);
    adaptEdge(*_places[index].cell);
}

void CrowdCells::findSeen(const std::vector<glm::vec4>& planes, std::vector<std::uint32_t>& outIndices) const
{
    static thread_local std::vector<std::uint64_t> seen; // a bit each; keeps its storage
    seen.assign((_spheres.size() + 63) / 64, 0);
    for (const auto& [key, cell] : _cells)
    {
        const Side side = sideOf(planes, cell.min, cell.max, cell.radius);
        if (side == Side::Outside) continue;
        const bool areAllSeen = side == Side::Inside && !cell.hasUnseen;
        for (const std::uint32_t index : cell.indices)
            seen[index / 64] |= static_cast<std::uint64_t>(areAllSeen || isSeen(planes, _spheres[index])) << index % 64;
    }
    std::size_t count = 0;
    for (const std::uint64_t bits : seen)
        count += static_cast<std::size_t>(__builtin_popcountll(bits));
    outIndices.resize(count);
    std::uint32_t* out = outIndices.data();
    for (std::size_t word = 0; word < seen.size(); ++word)
        for (std::uint64_t bits = seen[word]; bits != 0; bits &= bits - 1)
            *out++ = static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(__builtin_ctzll(bits)));
}

} // namespace osgGpuAnimation
