// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/RetargetOptions.h>
#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The result of withClipsOf().
struct RetargetedSet
{
    std::shared_ptr<const AnimationSet> set; ///< never null; its last clips are the new ones
    /// Joints and morphs of the set that have no counterpart: the new clips leave them at rest.
    std::vector<std::string> atRest;
    /// Joints and morphs that the other set's clips move and that have no counterpart in the set.
    std::vector<std::string> leftOut;
    // Of the joints with another rest pose:
    std::size_t byName = 0;     ///< the number that take the transforms as they are, see ClipMatch::ByName
    std::size_t retargeted = 0; ///< the number of the others
};

/// A set with the skeleton, skins, morphs and masks of one set, with its clips and then those of another one:
///
///     auto result = withClipsOf(knight->getAnimationSet(), general->getAnimationSet());
///     if (result) knight->setAnimationSet(result.value().set);
///
/// Joints and morphs are matched by name, see RetargetOptions. Where their rest poses agree, the clips are copied
/// bit by bit; RetargetOptions::match may want this elsewhere, too. Else rotations keep their difference from the rest
/// pose in model space (derived in WithClipsOf.cpp), so both characters must face the same way at rest; arms and legs
/// of known rigs (see findCounterparts()) point as in the clip, however they rest. The hips and the joints above them
/// move by the ratio of the hip heights, which is that of the legs; at each keyframe the hips are shifted along +Y, so
/// that the body's height above the ground is that of the clip times the ratio. Other translations are those of the
/// set's rest pose; factors of the rest scale are kept. What has no counterpart keeps its rest pose. Times, markers and
/// morph weights are copied. A name that the set's clips have gets a number: `Idle 2`. The new clips are exact: compact
/// ones may be compacted again (see compactClips()).
///
/// Errors: the other set has no clips; neither a joint nor a morph has a counterpart; a name in the options does
/// not exist; root motion was removed from a clip (see withRootMotion()) whose joint has another rest pose; errors
/// of AnimationSet::create().
Result<RetargetedSet> withClipsOf(const AnimationSet& set, const AnimationSet& other,
                                  const RetargetOptions& options = {});

} // namespace osgGpuAnimation
