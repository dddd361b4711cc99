// SPDX-License-Identifier: MIT
#pragma once

#include "../GltfDocument.h"

namespace osgGpuAnimation::scenes
{

/// The lantern as a mesh of its own (no skin, no texture): a brass frame and a glowing glass, hanging down from
/// the origin. Gives the mesh's index.
int addWandererLantern(GltfDocument& document);

} // namespace osgGpuAnimation::scenes
