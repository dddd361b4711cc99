// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdCells.h>

#include <osgGpuAnimation/math/detail/Builtins.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

constexpr float radiiOfFirstEdge = 16.0f;
constexpr std::size_t fewInCell = 8;    ///< fewer on average: the cells become larger
constexpr std::size_t manyInCell = 256; ///< more on average: the cells become smaller

/// Finds the planes that cross a cell; its spheres reach all others. False: they are all beyond one of the planes.
bool findCrossing(const std::vector<glm::vec4>& planes, const SeenMembers::Span& cell,
                  std::vector<glm::vec4>& outCrossing)
{
    outCrossing.clear();
    for (const glm::vec4& plane : planes)
    {
        const glm::vec3 normal(plane);
        const float distance = glm::dot(normal, cell.centre) + plane.w;
        const float reach = glm::dot(glm::abs(normal), cell.half);
        if (distance + reach < -cell.radius) return false;
        if (!(distance - reach >= 0.0f)) outCrossing.push_back(plane);
    }
    return true;
}

/// Without branches, which no processor could predict.
bool isSeen(const std::vector<glm::vec4>& planes, const glm::vec4& sphere)
{
    bool isSeen = sphere.w >= 0.0f;
    for (const glm::vec4& plane : planes)
        isSeen &= plane.x * sphere.x + plane.y * sphere.y + plane.z * sphere.z + plane.w >= -sphere.w;
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
    constexpr float maxCell = 1 << 30;
    Key key;
    for (int axis = 0; axis < 3; ++axis)
        key[static_cast<std::size_t>(axis)] =
            static_cast<std::int32_t>(std::floor(std::min(std::max(sphere[axis] / _edge, -maxCell), maxCell)));
    return key;
}

void CrowdCells::Cell::contain(const glm::vec4& sphere)
{
    min = glm::min(min, glm::vec3(sphere));
    max = glm::max(max, glm::vec3(sphere));
    radius = std::max(radius, sphere.w);
    hasUnseen = hasUnseen || !(sphere.w >= 0.0f);
}

void CrowdCells::put(const CrowdMember& member)
{
    const Key key = keyOf(member.sphere);
    const auto [found, isNew] = _cellOfKey.try_emplace(key, static_cast<std::uint32_t>(_cells.size()));
    if (isNew) _cells.emplace_back().key = key;
    Cell& cell = _cells[found->second];
    cell.contain(member.sphere);
    _places[member.index] = {found->second, static_cast<std::uint32_t>(cell.members.size())};
    cell.members.push_back(member);
}

void CrowdCells::takeOut(std::size_t index)
{
    const auto [number, position] = _places[index];
    std::vector<CrowdMember>& members = _cells[number].members;
    members[position] = members.back();
    _places[members[position].index].position = position;
    members.pop_back();
    if (members.empty()) removeCell(number);
}

/// Removes an empty cell; the last one gets its number.
void CrowdCells::removeCell(std::uint32_t number)
{
    _cellOfKey.erase(_cells[number].key);
    if (number + 1 != _cells.size())
    {
        _cells[number] = std::move(_cells.back());
        _cellOfKey[_cells[number].key] = number;
        for (const CrowdMember& member : _cells[number].members)
            _places[member.index].cell = number;
    }
    _cells.pop_back();
}

/// Cells of another size if the present ones have too few or too many instances on average.
void CrowdCells::adaptEdge(const Cell& used)
{
    const std::size_t count = _spheres.size(), cells = _cells.size();
    const bool isSparse = used.members.size() == 1 && cells > 64 && count < fewInCell * cells && _edge < 1e30f;
    const bool isDense = count > manyInCell * cells && _edge > 4.0f * used.radius && _edge > 1e-30f;
    if (!isSparse && !isDense) return;
    _edge *= isSparse ? 2.0f : 0.5f;
    _cellOfKey.clear();
    for (const Cell& cell : std::exchange(_cells, {}))
        for (const CrowdMember& member : cell.members)
            put(member);
}

void CrowdCells::add(const CrowdMember& member)
{
    const float radius = member.sphere.w;
    if (_edge == 0.0f) _edge = radius > 0.0f ? std::min(radiiOfFirstEdge * radius, 1e30f) : 1.0f;
    CrowdMember added = member;
    added.index = static_cast<std::uint32_t>(_spheres.size());
    _spheres.push_back(member.sphere);
    _places.emplace_back();
    put(added);
    adaptEdge(_cells[_places.back().cell]);
}

void CrowdCells::remove(std::size_t index)
{
    takeOut(index);
    if (index + 1 != _spheres.size())
    {
        _spheres[index] = _spheres.back();
        _places[index] = _places.back();
        _cells[_places[index].cell].members[_places[index].position].index = static_cast<std::uint32_t>(index);
    }
    _spheres.pop_back();
    _places.pop_back();
}

void CrowdCells::set(std::size_t index, const CrowdMember& member)
{
    CrowdMember changed = member;
    changed.index = static_cast<std::uint32_t>(index);
    _spheres[index] = member.sphere;
    Cell& cell = _cells[_places[index].cell];
    if (keyOf(member.sphere) == cell.key)
    {
        cell.contain(member.sphere);
        cell.members[_places[index].position] = changed;
        return;
    }
    takeOut(index);
    put(changed);
    adaptEdge(_cells[_places[index].cell]);
}

void CrowdCells::findSeen(const std::vector<glm::vec4>& planes, SeenMembers& outSeen) const
{
    outSeen._spans.clear();
    outSeen._partial.clear();
    std::size_t whole = 0, maxCopies = 0;
    std::vector<glm::vec4> crossing;
    for (const Cell& cell : _cells)
    {
        const std::size_t count = cell.members.size();
        const SeenMembers::Span span{cell.members.data(), cell.members.data() + count, 0.5f * (cell.min + cell.max),
                                     0.5f * (cell.max - cell.min), cell.radius};
        if (!findCrossing(planes, span, crossing)) continue;
        const bool isPartial = cell.hasUnseen || !crossing.empty();
        if (isPartial) outSeen._partial.push_back(outSeen._spans.size());
        (isPartial ? maxCopies : whole) += count;
        outSeen._spans.push_back(span);
    }
    if (outSeen._copies.size() < maxCopies) outSeen._copies.resize(maxCopies);
    CrowdMember* copies = outSeen._copies.data();
    for (const std::size_t partial : outSeen._partial)
    {
        SeenMembers::Span& span = outSeen._spans[partial];
        findCrossing(planes, span, crossing);
        CrowdMember* end = copies;
        for (const CrowdMember* member = span.begin; member != span.end; ++member)
        {
            *end = *member;
            end += isSeen(crossing, member->sphere);
        }
        span.begin = copies;
        span.end = copies = end;
    }
    outSeen._size = whole + static_cast<std::size_t>(copies - outSeen._copies.data());
}

void SeenMembers::findIndices(std::size_t instanceCount, std::vector<std::uint32_t>& outIndices) const
{
    static thread_local std::vector<std::uint64_t> seen; // a bit each; keeps its storage
    seen.assign((instanceCount + 63) / 64, 0);
    for (const Span& span : _spans)
        for (const CrowdMember* member = span.begin; member != span.end; ++member)
            seen[member->index / 64] |= std::uint64_t(1) << member->index % 64;
    outIndices.resize(_size);
    std::uint32_t* out = outIndices.data();
    for (std::size_t word = 0; word < seen.size(); ++word)
        for (std::uint64_t bits = seen[word]; bits != 0; bits &= bits - 1)
            *out++ = static_cast<std::uint32_t>(64 * word + countTrailingZeros(bits));
}

} // namespace osgGpuAnimation
