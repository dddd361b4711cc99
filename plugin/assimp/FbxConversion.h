// SPDX-License-Identifier: MIT
#pragma once

#include "fbx/Scene.h"
#include "gltf/file/Report.h"

struct aiScene;

namespace osgGpuAnimation::assimp
{

/// Adds to a scene that Assimp read from fbx.bytesForAssimp what Assimp loses: places each node where its pivots put
/// it, moves meshes by their geometric offsets, sets the weights of shapes at rest, marks hidden nodes (see
/// NodeMarks.h), and writes all takes as animations of seconds.
///
/// Tracks have the keys of the file, and more where interpolation between two keys would deviate from the curves: by
/// 0.001 radians in rotations, by 1/10,000 of the largest value elsewhere. Each take begins at 0 and ends at its
/// duration; a stepped key becomes two keys at neighbouring times.
///
/// Segment Scale Compensate becomes a node between the parent, where that is scaled, and the model.
void completeFbx(aiScene& scene, const fbx::Scene& fbx, gltf::Report& report);

} // namespace osgGpuAnimation::assimp
