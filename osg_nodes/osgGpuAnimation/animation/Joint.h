// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/JointTransform.h>

#include <string>

namespace osgGpuAnimation
{

/// A node of the file that moves, or that carries a node or mesh that moves.
struct Joint
{
    std::string name;    ///< not necessarily unique
    int parent = -1;     ///< index of the parent joint, -1 for a root
    JointTransform rest; ///< used if no clip animates the joint
    int sourceNode = -1; ///< number of the node in the file, -1 if it has none
};

} // namespace osgGpuAnimation
