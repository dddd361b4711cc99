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

/// The bounding spheres of a crowd's instances, in a grid of cells. Cull takes or leaves whole cells, so that instances
/// out of view cost next to nothing. The cells follow the spheres at once, and their size follows the density of the
/// crowd.
///
/// A sphere is centre and radius; a radius below 0: the instance is never seen.
class CrowdCells
{
public:
    CrowdCells() = default;
    CrowdCells(const CrowdCells& other);
    CrowdCells& operator=(const CrowdCells&) = delete;

    const glm::vec4& sphere(std::size_t index) const { return _spheres[index]; }
    std::size_t cellCount() const { return _cells.size(); } ///< cells with instances

    /// Adds an instance; its index is the number of those before.
    void add(const glm::vec4& sphere);
    /// Removes an instance; the last one gets its index.
    void remove(std::size_t index);
    void move(std::size_t index, const glm::vec4& sphere);

    /// The indices, ascending, of the instances whose sphere reaches n · p + d >= 0 of every plane. Safe to call from
    /// several threads.
    void findSeen(const std::vector<glm::vec4>& planes, std::vector<std::uint32_t>& outIndices) const;

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
        std::vector<std::uint32_t> indices;

        void contain(const glm::vec4& sphere);
    };
    struct Place
    {
        Cell* cell;
        std::uint32_t position; ///< in Cell::indices
    };

    Key keyOf(const glm::vec4& sphere) const;
    void put(std::size_t index);
    void takeOut(std::size_t index);
    void adaptEdge(const Cell& used);

    float _edge = 0.0f; ///< of a cell; 0: none yet
    std::unordered_map<Key, Cell, KeyHash> _cells;
    std::vector<glm::vec4> _spheres;
    std::vector<Place> _places;
};

} // namespace osgGpuAnimation
