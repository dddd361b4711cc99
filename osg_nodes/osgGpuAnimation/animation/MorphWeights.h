// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The morph weights of one mesh instance: one node of the file with a mesh that has morph targets. The GPU treats them
/// like joints: twelve weights form a **weight block**, which takes the 48 bytes of a joint transform in a keyframe and
/// the 48 bytes of a palette entry in the output.
///
/// A group of numbers without a node, named by a glTF JSON pointer, is a **property** of the file that clips animate,
/// for example `/materials/0/pbrMetallicRoughness/baseColorFactor`. Clips, layers and masks treat it like weights, but
/// no vertex depends on it: it has no palette entry, and Pose::properties() computes it on the CPU.
struct MorphWeights
{
    static constexpr std::size_t weightsPerBlock = 12; ///< the numbers of one JointTransform

    std::string name;            ///< not necessarily unique
    int sourceNode = -1;         ///< number of the node in the file
    std::vector<float> defaults; ///< one per target: the weights of the node, else of the mesh, else 0

    /// True for a property: no source node, and a name that begins with a slash.
    bool isProperty() const { return sourceNode < 0 && !name.empty() && name.front() == '/'; }
    /// blocks that hold all weights; the last may be partly used
    std::size_t blockCount() const { return (defaults.size() + weightsPerBlock - 1) / weightsPerBlock; }
};

} // namespace osgGpuAnimation
