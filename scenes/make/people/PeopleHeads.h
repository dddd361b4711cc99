// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

void addPeopleNeck(CharacterMesh& mesh);
void addPeopleEars(CharacterMesh& mesh);

/// Garments Hair, Bun, Beard, Hood, Hat and Cap. The hair fits below each of the last three, the bun not below the
/// hood.
void addPeopleHeads(CharacterMesh& mesh);

} // namespace osgGpuAnimation::scenes
