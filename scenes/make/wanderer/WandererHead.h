// SPDX-License-Identifier: MIT
#pragma once

#include "../CharacterMesh.h"

namespace osgGpuAnimation::scenes
{

/// Face, eyes, fringe and the pointed hood.
void addWandererHead(CharacterMesh& mesh);

// Its parts, for characters that combine them anew.

void addWandererFace(CharacterMesh& mesh);
void addWandererEyes(CharacterMesh& mesh);
void addWandererFringe(CharacterMesh& mesh, const Painter& painter);
void addWandererHood(CharacterMesh& mesh, const Painter& hood, const Painter& pompom);

/// The middle of the ellipsoid that the face is, and its half axes; metres.
extern const glm::dvec3 wandererFaceCenter;
extern const glm::dvec3 wandererFaceHalf;

} // namespace osgGpuAnimation::scenes
