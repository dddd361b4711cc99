// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

/// Garments Coat (to the thighs, with belt and buttons), Jacket (to the hips, with toggles) and Robe (to the knees,
/// with a sash). Above the waist they have the wanderer's outline, so that scarf and straps lie on each.
void addPeopleCoats(CharacterMesh& mesh);

} // namespace osgGpuAnimation::scenes
