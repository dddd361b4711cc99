// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Report.h"
#include "gltf/import/Joints.h"

#include <osgGpuAnimation/animation/Clip.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The clips of a file: one for each animation without a fault, in the file's order.
struct Clips
{
    std::vector<Clip> clips;
    std::vector<int> animationOfClip; ///< one per clip: the file's animation number
};

/// A clip that ClipBuilder refuses, or that exceeds the budget, is left out with a warning. Channels without a node are
/// skipped, as the specification requires. A clip without a name is named after its number, `clip 3`, one with a
/// generic name after the file. fileName: without folder and extension; empty: unknown.
///
/// Times are mended with a warning: of keys with equal times the last one remains; a channel whose times decrease is
/// skipped; a clip with times below 0 begins at the first of them.
///
/// Markers come from the animation's extras (glTF 2.0 leaves extras to applications):
///
///     "extras": { "markers": [ { "time": 0.2, "name": "left foot" }, { "time": 0.7, "name": "right foot" } ] }
///
/// time: seconds from the clip's beginning, 0 or more, clamped to its duration. A faulty marker is skipped with a
/// warning.
Clips readClips(const tinygltf::Model& model, const Joints& joints, const Morphs& morphs, const std::string& fileName,
                MemoryBudget& budget, Report& report);

/// True for the names that exporters give to every clip: Mixamo's `mixamo.com`, FBX's `Take 001`, `Motion` of a BVH.
bool isGenericClipName(const std::string& name);

} // namespace osgGpuAnimation::gltf
