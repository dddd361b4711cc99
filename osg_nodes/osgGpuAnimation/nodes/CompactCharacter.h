// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <vector>

namespace osgGpuAnimation
{

/// How far the clips of a character are off since they are compact, in its own units.
struct CompactedCharacter
{
    double longestSide = 0.0; ///< see animation/CompactClips.h
    double tolerance = 0.0;
    std::vector<double> errors; ///< one a clip; 0 where it is exact
};

/// Gives the character a set with compact clips, see animation/CompactClips.h: no vertex is farther from where the
/// exact clips have it than that fraction of the model's longest side. To be called when all meshes are in, and before
/// cloning. Errors: those of compactClips() and AnimatedCharacter::setAnimationSet(); a model without size.
Result<CompactedCharacter> compactClipsOf(AnimatedCharacter& character, double fraction);

} // namespace osgGpuAnimation
