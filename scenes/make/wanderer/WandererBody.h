// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

/// The wanderer below the neck: coat, sleeves, gloves, trousers and boots.
void addWandererBody(CharacterMesh& mesh);

/// The coat's outline at a height in metres, for what lies on it.
LoftRing wandererCoatAt(double height);

} // namespace osgGpuAnimation::scenes
