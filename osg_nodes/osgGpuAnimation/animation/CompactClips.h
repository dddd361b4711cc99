// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Bounds.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

struct CompactOptions
{
    /// In the model's units, above 0: how far a vertex, or the origin of a joint, may be from where the exact clip has
    /// it. A fraction of longestSide(), say.
    double tolerance = 0.0;
};

/// The set with compact clips, and how far each clip is off.
struct CompactedSet
{
    std::shared_ptr<const AnimationSet> set;
    std::vector<double> errors; ///< one a clip, in the model's units; 0 where it was left as it is
};

/// The set with its clips made smaller, on the GPU and on the CPU: what hardly moves is held still, keyframes that
/// their neighbours tell are dropped, and numbers are rounded to 20 bits of their range, see CompactTracks.
///
///     const auto compact = compactClips(set, entryBoxes, {1e-4 * longestSide(set, entryBoxes)});
///
/// The error is looked for at every keyframe of the exact clip and halfway between them, at the corners of the boxes of
/// what each palette entry moves (a vertex is a convex combination of those) and at the joints' origins; a clip that
/// cannot be brought below the tolerance stays exact. Left as they are: Spline clips, clips that are compact already.
/// Morph weights and the keyframes of clips with root motion are kept exactly. Mixed clips are as far off as the clips
/// are; additive layers as far as the clip and its reference together.
///
/// Errors: a tolerance that is not a number above 0; not a box a palette entry.
Result<CompactedSet> compactClips(const AnimationSet& set, const EntryBoxes& entryBoxes, const CompactOptions& options);

/// The longest side of the box of the rest pose, in the model's units; of its joints' origins where no entry moves
/// vertices.
double longestSide(const AnimationSet& set, const EntryBoxes& entryBoxes);

} // namespace osgGpuAnimation
