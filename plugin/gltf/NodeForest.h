// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The nodes of a document as the trees they must form (glTF 2.0, section 3.5.2). One that exists has no cycle, no node
/// with two parents and no branch deeper than allowed.
class NodeForest
{
public:
    /// Errors: nodes[2].children[0]: a node with two parents, a cycle, a branch of more than mostDepth nodes.
    static Result<NodeForest> create(const tinygltf::Model& model, std::size_t mostDepth);

    /// One a node: its parent, -1 for a root.
    const std::vector<int>& parents() const { return _parents; }
    /// One a node: the root of its tree.
    const std::vector<int>& roots() const { return _roots; }

private:
    NodeForest(std::vector<int> parents, std::vector<int> roots)
        : _parents(std::move(parents)), _roots(std::move(roots))
    {
    }

    std::vector<int> _parents;
    std::vector<int> _roots;
};

} // namespace osgGpuAnimation::gltf
