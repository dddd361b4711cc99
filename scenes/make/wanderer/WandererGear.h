// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

/// What the wanderer wears over the coat: scarf, belt, buttons, satchel and strap.
void addWandererGear(CharacterMesh& mesh);

// Its parts, for characters that combine them anew.

/// Wound around the neck, with a tail on the back.
void addWandererScarf(CharacterMesh& mesh, const Painter& scarf, const Painter& tail);
/// A satchel on the right hip, and its strap.
void addWandererBag(CharacterMesh& mesh);
void addWandererBelt(CharacterMesh& mesh);
void addWandererBuckle(CharacterMesh& mesh);
void addWandererButtons(CharacterMesh& mesh);

} // namespace osgGpuAnimation::scenes
