// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/ImportOptions.h"

#include <osgGpuAnimation/math/Result.h>

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// A level of detail of a node (MSFT_lod).
struct NodeLevel
{
    int node = -1;          ///< the level's own
    int firstNode = -1;     ///< that of the group's first level: the node that it stands for
    std::size_t group = 0;  ///< the same for all levels of one node
    float minPixels = 0.0f; ///< the size on screen that it is drawn from: the diameter of its bounding sphere
    float maxPixels = 0.0f; ///< and below which; the largest float for the most detailed level
};

/// The nodes of a file as a forest, and the part of it that is drawn: the chosen scene's. All vectors but `roots`
/// and `levels` have one element per node of the file.
struct NodeTree
{
    int scene = -1;                  ///< the chosen scene; -1: the file has none, and all its roots are drawn
    std::vector<int> parents;        ///< -1 for roots
    std::vector<int> order;          ///< all nodes, parents first
    std::vector<int> roots;          ///< of the drawn part
    std::vector<bool> drawn;         ///< at or below one of `roots`
    std::vector<glm::dmat4> toWorld; ///< at rest
    std::vector<bool> hidden;        ///< it or a node above is not visible (KHR_node_visibility), in no clip
    std::vector<bool> hiddenAtRest;  ///< the same at rest, where clips animate the visibility, too
    std::vector<int> visibility;     ///< the nearest node, itself or above, whose visibility clips animate; -1: none
    /// Levels of detail: siblings of the node that they stand for. No level is below another.
    std::vector<NodeLevel> levels;
    std::vector<int> levelOf; ///< the index into `levels` of the level that the node is, or is part of; -1: none

    /// True if the node at rest mirrors, so that front faces become back faces.
    bool isMirrored(int node) const;
    /// The node whose visibility counts for this one, too: its parent; of a further level of detail, the node that it
    /// stands for. -1: none.
    int above(int node) const;
    /// All nodes that decide with this one: itself and those above whose visibility clips animate. node: one of
    /// `visibility`; -1: none.
    std::vector<int> visibilityWith(int node) const;
};

/// Error: the options name a scene that the file does not have.
Result<NodeTree> buildNodeTree(const tinygltf::Model& model, const ImportOptions& options);

} // namespace osgGpuAnimation::gltf
