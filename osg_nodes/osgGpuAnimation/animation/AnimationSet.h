// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/Palette.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>
#include <osgGpuAnimation/animation/Result.h>
#include <osgGpuAnimation/animation/Skeleton.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

class MaskTable;

/// The input of AnimationSet::create().
struct AnimationParts
{
    Skeleton skeleton;
    std::vector<Skin> skins;
    std::vector<int> rigidJoints; ///< joints that carry a mesh without a skin
    std::vector<MorphWeights> morphs;
    std::vector<Clip> clips; ///< created for the same skeleton and morphs
};

/// Skeleton, palette and clips of one kind of character. It is immutable; all instances of the character share it on
/// the CPU and, once per graphics context, on the GPU. A **track** is one JointTransform in every keyframe: first the
/// tracks of the joints, then those of the weight blocks.
class AnimationSet
{
public:
    /// Errors: a skin or rigid joint out of range, a skin with fewer matrices than joints, a matrix or default weight
    /// that is not finite, a clip with a wrong number of tracks, more keyframes than 32-bit offsets reach.
    static Result<std::shared_ptr<const AnimationSet>> create(AnimationParts parts);

    ~AnimationSet();

    /// A set with the same skeleton, skins, morphs and masks but other clips, for example with markers (see
    /// Clip::withMarkers). Its palette is the same, so the meshes of this set fit it. Errors: those of create().
    Result<std::shared_ptr<const AnimationSet>> withClips(std::vector<Clip> clips) const;

    const Skeleton& skeleton() const { return _parts.skeleton; }
    const std::vector<Skin>& skins() const { return _parts.skins; }
    const std::vector<int>& rigidJoints() const { return _parts.rigidJoints; } ///< as passed to create()
    const std::vector<MorphWeights>& morphs() const { return _parts.morphs; }
    const std::vector<Clip>& clips() const { return _parts.clips; }

    std::size_t trackCount() const { return _restPose.size(); }
    const std::vector<JointTransform>& restPose() const { return _restPose; } ///< trackCount() transforms
    std::size_t firstTrackOfMorph(std::size_t morph) const { return _firstTracksOfMorphs[morph]; }

    const std::vector<PaletteEntry>& palette() const { return _layout.entries; }
    std::size_t paletteSize() const { return _layout.entries.size(); }
    /// levelCount() + 1 entry indices: level l is [levels()[l], levels()[l + 1]).
    const std::vector<std::size_t>& levels() const { return _layout.levels; }
    std::size_t levelCount() const { return _layout.levels.size() - 1; }

    /// The palette entry of the joint at an index of Skin::joints.
    int entryOfSkin(std::size_t skin, std::size_t place) const { return _layout.entryOfSkin[skin][place]; }
    /// The palette entries of all joints of a skin, in the order of Skin::joints.
    const std::vector<int>& entriesOfSkin(std::size_t skin) const { return _layout.entryOfSkin[skin]; }
    /// The entry with an identity inverse bind for a joint that carries a rigid mesh; -1 for other joints.
    int entryOfRigidJoint(int joint) const;
    /// The joint's main entry; jointToModel = entry · (that entry's inverseBind)⁻¹.
    int mainEntry(int joint) const { return _layout.mainEntry[static_cast<std::size_t>(joint)]; }
    /// The entry of a morph's first weight block; the others follow it. -1 if the morph has no weights.
    int entryOfMorph(std::size_t morph) const { return _layout.entryOfMorph[morph]; }

    /// The first clip of that name; -1 if there is none.
    int findClip(const std::string& name) const;
    /// The clip of that name or number. Error: there is no such clip; the message lists the existing names.
    Result<std::size_t> clipNamed(const std::string& name) const;
    Result<std::size_t> clipAt(std::size_t clip) const;

    /// The number of a clip's first keyframe. Number 0 is the rest pose, then come the keyframes of all clips in turn
    /// (see BlendSample::keyframe).
    std::size_t firstKeyframe(std::size_t clip) const { return _firstKeyframes[clip]; }
    std::size_t keyframeCount() const { return _keyframeCount; } ///< of the rest pose and all clips
    /// A blend sample of weight 1. clip: -1 gives the rest pose. time: seconds on the time line of the clip.
    BlendSample sampleAt(int clip, double time) const;

    /// Adds a mask that layers can use and returns its number, from 1 on (see BlendSample::control). Masks are never
    /// removed, so adding one to a set in use is safe; equal masks share a number. Safe to call from several threads.
    /// weights: one per track, in [0, 1], see JointMask::weights().
    /// Errors: a wrong number of weights; the set has MaskTable::maxMasks masks.
    Result<std::uint32_t> addMask(const std::vector<float>& weights) const;
    const MaskTable& masks() const { return *_masks; }

private:
    AnimationSet(AnimationParts parts, const MaskTable& masks);
    static Result<std::shared_ptr<const AnimationSet>> make(AnimationParts parts, const MaskTable& masks);

    AnimationParts _parts;
    std::vector<JointTransform> _restPose;
    std::vector<std::size_t> _firstTracksOfMorphs; ///< and at the end the number of tracks
    PaletteLayout _layout;
    std::vector<std::size_t> _firstKeyframes;
    std::size_t _keyframeCount = 1;
    std::unique_ptr<MaskTable> _masks;
};

} // namespace osgGpuAnimation
