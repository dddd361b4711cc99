// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

/// Face, eyes, fringe and the pointed hood.
void addWandererHead(CharacterMesh& mesh);

} // namespace osgGpuAnimation::scenes
