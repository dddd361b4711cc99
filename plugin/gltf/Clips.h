// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/DecodedBytes.h"
#include "gltf/Joints.h"
#include "gltf/Morphs.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Clip.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// The clips of a file: one for each animation, in the file's order, those left out that are at fault.
struct Clips
{
    std::vector<Clip> clips;
    std::vector<int> animationOfClip; ///< one a clip: the file's animation number
};

/// A fault in an animation, or one that would take more memory than the budget has, costs that clip, with a warning.
/// Channels without a node are skipped, as the specification says; those with an unknown path or a property that
/// another channel drives already are skipped with a warning. A clip without a name is called by its number, `clip 3`.
/// Markers come from the animation's extras, see readMarkers().
Clips readClips(const tinygltf::Model& model, const Joints& joints, const Morphs& morphs, DecodedBytes& budget,
                Report& report);

} // namespace osgGpuAnimation::gltf
