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
///     joints       count, depth (levels of the hierarchy), roots (names)
///     skins        name, joints                         a skin
///     paletteEntries
///     clips        index (the file's), name, seconds, keyframes, form (linear or spline)
///     meshes       count, primitives, vertices, skinned, rigid, still (primitives each), morphTargets
///     materials, extensions                             names
///     gpuBytes     animation, meshes, textures, total   in GPU buffers, without the driver's own memory
///     warnings, notes
nlohmann::ordered_json reportModel(const gltf::ImportedModel& model, const std::string& fileName);
std::string reportText(const nlohmann::ordered_json& report);

} // namespace osgGpuAnimation::tool
