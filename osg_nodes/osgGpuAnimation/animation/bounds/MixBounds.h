// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/playback/PlayedClip.h>
#include <osgGpuAnimation/math/Box.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace osgGpuAnimation
{

struct JointRange;

/// Boxes that contain a character while clips are mixed: crossfades, layers, masks, additive layers. A mix can leave
/// the boxes of all its clips: an arm that hangs and an arm behind the back mix to an arm at the side. So MixBounds
/// bounds the joint-to-model transforms of the mix from root to leaf: a ball contains the origin of the joint, and a
/// matrix with a radius contains the linear part. Where these bounds exceed the joint's distance from the root, that
/// distance is the bound.
/// A pose of the application counts with its extent.
///
/// The boxes are conservative for any times, weights and masks. They are close to the clips' own boxes if the joints
/// rotate little.
///
/// Safe to use from several threads. It caches the ranges of each clip.
class MixBounds
{
public:
    /// The boxes of the vertices that the palette entries move, for different morph weights.
    struct Boxes
    {
        EntryBoxes ofClips;         ///< all weights of the clips; one box per palette entry, like the others
        EntryBoxes withAdded;       ///< the weights of the clips, changed by maxLayers additive layers
        EntryBoxes withPosed;       ///< the weights of the clips, and any in [-1, 1]
        std::vector<float> reaches; ///< the farthest that weights in [-1, 1] move a vertex
    };

    /// The set must outlive this object.
    MixBounds(const AnimationSet& set, Boxes boxes);

    /// The box in model space. Unknown clips count as the rest pose. constraints: those of the set with an effect, bit
    /// c for constraint c; they may turn the joints of their chains in any way.
    Box box(const std::vector<PlayedClip>& played, std::uint64_t constraints = 0) const;

private:
    using Ranges = std::vector<JointRange>;

    const Clip* findClip(int clip) const; ///< null for the rest pose
    std::shared_ptr<const Ranges> rangesOf(int clip) const;
    Ranges rangesOf(const std::vector<PlayedClip>& played) const;

    Box entryBox(const std::vector<PlayedClip>& played, std::size_t entry) const;

    const AnimationSet& _set;
    Boxes _boxes;
    double _maxRestWeight = 0.0; ///< no morph weight of the rest pose has a larger absolute value
    mutable std::mutex _mutex;
    mutable std::map<int, std::shared_ptr<const Ranges>> _ranges; ///< by clip
};

} // namespace osgGpuAnimation
