// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

/// The wanderer below the neck: coat, sleeves, gloves, trousers and boots.
void addWandererBody(CharacterMesh& mesh);

// Its parts, for characters that combine them anew.

void addWandererSleeves(CharacterMesh& mesh, const Painter& painter);
void addWandererGloves(CharacterMesh& mesh, const Painter& painter);
void addWandererTrousers(CharacterMesh& mesh, const Painter& painter);
void addWandererBoots(CharacterMesh& mesh, const Painter& boot, const Painter& sole);

/// The coat's rings from the neck to the hem.
const std::vector<LoftRing>& wandererCoatRings();
/// A level ring of a coat; below the waist it has room for the thighs.
LoftRing wandererCoatRing(double height, double side, double front, double back);
/// The coat's outline at a height in metres, for what lies on it.
LoftRing wandererCoatAt(double height);

} // namespace osgGpuAnimation::scenes
