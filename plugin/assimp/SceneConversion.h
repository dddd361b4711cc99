// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <string>

struct aiScene;

namespace osgGpuAnimation::assimp
{

/// An Assimp scene as GLB: nodes, meshes with skins and morph targets, materials with their pictures, and every
/// animation, with key times in seconds. Lights and cameras are left out. Assimp's own glTF export is not used: it
/// writes one skin for all meshes and no animation of morph targets.
///
/// The scene must be triangulated and have one kind of primitive a mesh (aiProcess_Triangulate, aiProcess_SortByPType)
/// and at most four bones a vertex (aiProcess_LimitBoneWeights). Its upward axis is turned to +Y by the scene's
/// metadata (`UpAxis`, `FrontAxis`, `CoordAxis`), if there are any.
///
/// modelFile: in whose folder, or in the folder `textures` there, pictures are searched for by their names without
/// folders, if they are not where the scene says.
/// Errors: more than options.maxDecodedBytes; a hierarchy deeper than options.maxNodeDepth.
Result<std::string> glbOf(const aiScene& scene, const std::string& modelFile, const gltf::ImportOptions& options,
                          gltf::Report& report);

} // namespace osgGpuAnimation::assimp
