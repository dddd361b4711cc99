// SPDX-License-Identifier: MIT
#pragma once

#include "../GltfDocument.h"

namespace osgGpuAnimation::scenes
{

// What the left hand carries besides the lantern: meshes of their own without skin and texture, around the origin in
// the fist. They give the mesh's index.

/// A wicker basket that hangs down on its handle.
int addPeopleBasket(GltfDocument& document);
/// A staff with a knob, which reaches down to the ground.
int addPeopleStaff(GltfDocument& document);

} // namespace osgGpuAnimation::scenes
