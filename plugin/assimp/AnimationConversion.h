// SPDX-License-Identifier: MIT
#pragma once

#include "assimp/MeshConversion.h"

#include <map>
#include <string>

struct aiMeshMorphAnim;
struct aiScene;

namespace osgGpuAnimation::assimp
{

/// The glTF nodes with morph targets below (or at) a node of Assimp's, and their numbers of targets.
using MorphedNodes = std::multimap<std::size_t, std::pair<std::size_t, std::size_t>>;

/// The node of a channel. Assimp's reader of FBX appends "*" and the number of the geometry to the node's name.
std::string morphedNode(const aiMeshMorphAnim& channel);

/// Writes all animations, with linear keys. Times become seconds, from 0 on; without ticks per second, 25 are assumed.
/// Keys that are not finite or go back in time are left out; of two keys at one time, the second follows at the next
/// float.
void writeAnimations(const aiScene& scene, const NodeNumbers& nodes, const MorphedNodes& morphed,
                     gltf::GlbWriter& writer, gltf::Report& report);

} // namespace osgGpuAnimation::assimp
