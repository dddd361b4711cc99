// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <vector>

namespace osgGpuAnimation
{

/// An axis-aligned box; empty (min > max) until something is added.
struct Box
{
    glm::vec3 min{1e30f};
    glm::vec3 max{-1e30f};

    bool empty() const { return min.x > max.x; }
    void add(const glm::vec3& point);
    void add(const Box& box);
    void grow(float margin);       ///< on every side; nothing where empty
    glm::vec3 corner(int i) const; ///< i in [0, 8): bit 0 set is at max.x, bit 1 at max.y, bit 2 at max.z
};

/// For each palette entry, the box of the vertices it moves, in the mesh's space at bind time (before the entry).
using EntryBoxes = std::vector<Box>;

/// The box, in the model's space, that holds every vertex at every time of the clip: conservative (a vertex is a convex
/// combination of where its entries take it, and between the times looked at the arcs' heights are added) and tight
/// (looked at as often as the joints' turning asks for). clip -1: the rest pose.
Box boundsOfClip(const AnimationSet& set, int clip, const EntryBoxes& entryBoxes);

/// The rest pose's and then those of all clips in turn: clip c's is at c + 1.
std::vector<Box> boundsOfClips(const AnimationSet& set, const EntryBoxes& entryBoxes);

} // namespace osgGpuAnimation
