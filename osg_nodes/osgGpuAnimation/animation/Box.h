// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace osgGpuAnimation
{

/// An axis-aligned box. Default: empty (min > max).
struct Box
{
    glm::vec3 min{1e30f};
    glm::vec3 max{-1e30f};

    bool empty() const { return min.x > max.x; }
    void add(const glm::vec3& point);
    void add(const Box& box);
    void grow(float margin);       ///< moves every face outwards by margin; an empty box stays empty
    glm::vec3 corner(int i) const; ///< i: in [0, 8); bit 0 selects max.x, bit 1 max.y, bit 2 max.z
};

/// For each palette entry, the box of the vertices that it moves, in the mesh's space at bind time (before the entry).
using EntryBoxes = std::vector<Box>;

} // namespace osgGpuAnimation
