// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Result.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// Options of compactClips().
struct CompactOptions
{
    /// The largest error of a vertex or a joint in the model's units, above 0: for example a fraction of
    /// longestSide().
    double tolerance = 0.0;
};

/// A set with compact clips, and their errors.
struct CompactedSet
{
    std::shared_ptr<const AnimationSet> set; ///< never null
    std::vector<double> errors;              ///< one per clip, in the model's units; 0 for an unchanged clip
};

/// Makes the clips of a set smaller, on the GPU and on the CPU: parts that hardly move become constant, keyframes that
/// their neighbours predict are dropped, and each number of a part takes as few bits as the error allows, 0 to 20.
///
///     const auto compact = compactClips(set, entryBoxes, {1e-4 * longestSide(set, entryBoxes)});
///
/// The error is measured at every keyframe of the exact clip and halfway between them: at the joints' origins, at half
/// the longestSide() from them along each axis of the joint (where something may be attached), and at the corners of
/// the entries' boxes (a vertex is a convex combination of those). A clip that would exceed the tolerance stays exact,
/// as do Spline clips and clips that are compact already. Morph weights, and the keyframes of clips with root motion,
/// are kept exactly. A mix of clips has at most their errors; an additive layer adds the errors of the clip and of its
/// reference.
///
/// entryBoxes: one box per palette entry. Errors: a tolerance that is not finite and above 0; a wrong number of boxes.
Result<CompactedSet> compactClips(const AnimationSet& set, const EntryBoxes& entryBoxes, const CompactOptions& options);

/// The longest side of the rest pose's box in the model's units; of its joints' origins if no entry moves vertices.
double longestSide(const AnimationSet& set, const EntryBoxes& entryBoxes);

} // namespace osgGpuAnimation
