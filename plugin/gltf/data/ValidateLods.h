// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"

#include <tiny_gltf.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Levels of detail of nodes (MSFT_lod): the levels below the node's own are nodes that are drawn in its place. They
/// are roots of the file, or siblings of the node, each in one list only. No level is above or below a node with
/// levels, so the nodes remain trees after each level has become a sibling of its node. A scene that names a level
/// names its node, too. A list with a fault is left out with a warning; the node itself is then the only level.
///
/// MSFT_screencoverage in the extras has one number for each level, or none for the last: from 1 to 0, not ascending.
/// Others are left out with a warning. Levels of materials are left out with one note.
/// model: its nodes are valid, see validateNodes(). maxDepth: of the nodes with their levels, as there.
void validateLods(tinygltf::Model& model, std::size_t maxDepth, Report& report);

/// A node with its levels of detail.
struct LodGroup
{
    std::vector<int> nodes; ///< the file's numbers; the first is the node itself, its most detailed level
    /// One per level, in [0, 1], not ascending: the smallest share of the view's height that the level is for.
    std::vector<double> shares;
};

/// The groups of a document that has passed validateLods(). Without MSFT_screencoverage the first level is for shares
/// from 0.25, each following one for half the share before, the last for all smaller ones.
std::vector<LodGroup> readLods(const tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
