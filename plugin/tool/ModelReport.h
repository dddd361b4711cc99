// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Import.h"

#include <nlohmann/json.hpp>

#include <string>

namespace osgGpuAnimation::tool
{

/// The content of an imported file and its memory, as JSON or as text made from that JSON.
///
///     file, generator, scene
///     joints       count, depth (levels of the hierarchy), roots (names), list (name, parent: an index or -1)
///     skins        name, joints                         a skin
///     paletteEntries
///     bounds       of the rest pose in the file's axes: [least corner, greatest corner], null if nothing is drawn
///     clips        index (the file's), name, seconds, keyframes, form (linear or spline), bounds (of what moves)
///     meshes       count, primitives, vertices, skinned, rigid, still (primitives each), morphTargets
///     materials    name, alphaMode (OPAQUE, MASK, BLEND), alphaCutoff (of MASK), doubleSided, unlit, maps (map, image:
///     the
///                  file's index, size: [width, height], null for a missing picture)
///     variants, extensions                              names
///     gpuBytes     animation, meshes, textures, total   in GPU buffers, without the driver's own memory
///     warnings, notes
nlohmann::ordered_json reportModel(const gltf::ImportedModel& model, const std::string& fileName);
std::string reportText(const nlohmann::ordered_json& report);

} // namespace osgGpuAnimation::tool
