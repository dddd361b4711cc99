// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

/// What the wanderer wears over the coat: scarf, belt, buttons, satchel and strap.
void addWandererGear(CharacterMesh& mesh);

} // namespace osgGpuAnimation::scenes
