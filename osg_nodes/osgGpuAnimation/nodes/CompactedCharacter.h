// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <vector>

namespace osgGpuAnimation
{

/// The errors of a character's compact clips.
struct CompactedCharacter
{
    double longestSide = 0.0;   ///< of the model, in its own units
    double tolerance = 0.0;     ///< the largest allowed error, in the model's units
    std::vector<double> errors; ///< one per clip, in the model's units; 0: the clip stays exact
};

/// Replaces the character's clips by compact ones (see compactClips): no vertex moves by more than the fraction of the
/// model's longest side. Call it after all meshes are added and before cloning.
/// fraction: above 0. Errors: those of compactClips() and AnimatedCharacter::setAnimationSet(); the model has no size.
Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction);

} // namespace osgGpuAnimation
