// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Bounds.h>
#include <osgGpuAnimation/animation/PlayedClips.h>

#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

struct JointRange;

/// The boxes that hold a character while clips are mixed: crossfades, layers, masks, additive layers. Two poses mixed
/// joint by joint can leave both poses' boxes (an arm that hangs and an arm behind the back mix to one at the side), so
/// here joint by joint what the mixed transforms can be (JointRange) goes from root to leaf as a ball and a matrix with
/// a radius; where that gets wider than a joint's reach, its reach holds. Conservative for any times, weights and
/// masks; for joints that turn little it is nearly the clips' own boxes, for those that turn far it is their reach.
///
/// Safe to use from several threads. What it learns of a clip it keeps.
class MixBounds
{
public:
    /// The set must outlive it. entryBoxes as for boundsOfClip(); withAdded: the same with morph weights that maxLayers
    /// additive layers have changed.
    MixBounds(const AnimationSet& set, EntryBoxes entryBoxes, EntryBoxes withAdded);
    ~MixBounds();

    /// In the model's space. Clips that are not in the set count as the rest pose.
    Box box(const std::vector<PlayedClip>& played) const;

private:
    using Ranges = std::vector<JointRange>;

    std::shared_ptr<const Ranges> rangesOf(int clip) const;
    const JointTransform& firstOf(int clip, std::size_t joint) const;
    Ranges rangesOf(const std::vector<PlayedClip>& played) const;

    const AnimationSet& _set;
    EntryBoxes _entryBoxes, _withAdded;
    mutable std::mutex _mutex;
    mutable std::map<int, std::shared_ptr<const Ranges>> _ranges; ///< by clip
};

} // namespace osgGpuAnimation
