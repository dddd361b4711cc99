// SPDX-License-Identifier: MIT
#pragma once

#include "GltfDocument.h"
#include "Rig.h"

#include <string>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// A node for each joint, under `root`: their indices, in the rig's order.
std::vector<int> addRigNodes(GltfDocument& document, const Rig& rig, int root);
/// A skin of the rig's skinned joints, which must come first in the rig.
int addRigSkin(GltfDocument& document, const std::string& name, const Rig& rig, const std::vector<int>& nodes);

} // namespace osgGpuAnimation::scenes
