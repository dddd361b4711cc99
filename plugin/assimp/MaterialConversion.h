// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GlbWriter.h"
#include "gltf/file/Report.h"

#include <string>

struct aiScene;

namespace osgGpuAnimation::assimp
{

/// Writes a glTF material for each of the scene's, in their order, with its pictures. What a material of an older
/// format says of highlights becomes roughness: 1 - sqrt(exponent) / 10 for exponents up to 100, as Blender's exporter
/// of FBX has it. A texture replaces the base colour, as in FBX.
/// PNG and JPEG are taken as they are, TGA and BMP become PNG by OSG's plugins; other pictures are left out with a
/// warning. modelFile: see glbOf().
void writeMaterials(const aiScene& scene, const std::string& modelFile, gltf::GlbWriter& writer, gltf::Report& report);

} // namespace osgGpuAnimation::assimp
