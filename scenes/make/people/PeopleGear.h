// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

/// Garments Scarf, Bag (a satchel with its strap) and Pack (on the back, where the scarf's tail hangs: it excludes it).
void addPeopleGear(CharacterMesh& mesh);

} // namespace osgGpuAnimation::scenes
