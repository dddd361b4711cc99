// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

/// The properties of an instance that cull reads, side by side: memory traffic decides the cost of cull.
struct CrowdMember
{
    static constexpr int controlled = -2; ///< a clip: the instance has a controller

    CrowdMember(const glm::vec4& sphere = glm::vec4(0.0f, 0.0f, 0.0f, -1.0f)) : sphere(sphere) {}

    glm::vec4 sphere;        ///< centre, radius; a radius below 0: the instance is never seen
    double offset = 0.0;     ///< clip seconds at clock 0
    double speed = 0.0;      ///< clip seconds per second of the clock
    int clip = -1;           ///< -1: the rest pose
    float scale = 1.0f;      ///< the largest of the root matrix
    std::uint32_t index = 0; ///< of the instance; CrowdCells sets it
};

/// The visible members of a crowd, cell by cell. It keeps its storage from cull to cull.
class SeenMembers
{
public:
    /// Visible members of one cell, maybe none, and bounds of all members of the cell.
    struct Span
    {
        const CrowdMember* begin;
        const CrowdMember* end;
        glm::vec3 centre, half; ///< of the box around the centres of the spheres
        float radius;           ///< the largest
    };

    const std::vector<Span>& spans() const { return _spans; }
    std::size_t size() const { return _size; } ///< members
    /// Their indices, ascending. instanceCount: of the crowd.
    void findIndices(std::size_t instanceCount, std::vector<std::uint32_t>& outIndices) const;

private:
    friend class CrowdCells;

    std::vector<Span> _spans;
    std::vector<std::size_t> _partial; ///< spans of cells that are seen in part
    std::vector<CrowdMember> _copies;  ///< the members of these
    std::size_t _size = 0;
};

/// The bounding spheres of a crowd's instances, in a grid of cells. Cull takes or leaves whole cells, so that instances
/// out of view cost next to nothing. The cells follow the spheres at once, and their size follows the density of the
/// crowd.
class CrowdCells
{
public:
    const glm::vec4& sphere(std::size_t index) const { return _spheres[index]; }
    std::size_t cellCount() const { return _cells.size(); } ///< cells with instances

    /// Adds an instance; its index is the number of those before.
    void add(const CrowdMember& member);
    /// Removes an instance; the last one gets its index.
    void remove(std::size_t index);
    /// Replaces the member of an instance.
    void set(std::size_t index, const CrowdMember& member);

    /// The instances whose sphere reaches n · p + d >= 0 of every plane; valid until an instance changes. Safe to call
    /// from several threads.
    void findSeen(const std::vector<glm::vec4>& planes, SeenMembers& outSeen) const;

private:
    using Key = std::array<std::int32_t, 3>;
    struct KeyHash
    {
        std::size_t operator()(const Key& key) const;
    };
    struct Cell
    {
        Key key{};
        glm::vec3 min{1e38f}, max{-1e38f}; ///< of all centres and radii so far: they never shrink
        float radius = 0.0f;
        bool hasUnseen = false; ///< a sphere with a radius below 0 was in the cell
        std::vector<CrowdMember> members;

        void contain(const glm::vec4& sphere);
    };
    struct Place
    {
        std::uint32_t cell;
        std::uint32_t position; ///< in Cell::members
    };

    Key keyOf(const glm::vec4& sphere) const;
    void put(const CrowdMember& member);
    void takeOut(std::size_t index);
    void removeCell(std::uint32_t number);
    void adaptEdge(const Cell& used);

    float _edge = 0.0f;       ///< of a cell; 0: none yet
    std::vector<Cell> _cells; ///< side by side: cull reads all their bounds
    std::unordered_map<Key, std::uint32_t, KeyHash> _cellOfKey;
    std::vector<glm::vec4> _spheres;
    std::vector<Place> _places;
};

} // namespace osgGpuAnimation
