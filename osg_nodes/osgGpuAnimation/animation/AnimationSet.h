// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationParts.h>
#include <osgGpuAnimation/animation/MaskTable.h>
#include <osgGpuAnimation/animation/PaletteEntry.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>
#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

struct ConstraintChain;
struct Box;
/// For each palette entry, the box of the vertices that it moves, in the mesh's space at bind time.
using EntryBoxes = std::vector<Box>;

/// Skeleton, palette and clips of one kind of character. It is immutable; all instances of the character share it on
/// the CPU and, once per graphics context, on the GPU. A **track** is one JointTransform in every keyframe: first the
/// tracks of the joints, then those of the weight blocks.
class AnimationSet
{
public:
    static constexpr std::size_t maxConstraints = 64; ///< of one set

    /// Errors: a skin or rigid joint out of range, a skin with fewer matrices than joints, a matrix or default weight
    /// that is not finite, a clip with a wrong number of tracks, more keyframes than 32-bit offsets reach, a
    /// constraint as in withConstraints().
    static Result<std::shared_ptr<const AnimationSet>> create(AnimationParts parts);

    /// The set; if it is null, a set without joints and clips, which characters and crowds have before they get one.
    static std::shared_ptr<const AnimationSet> orEmpty(std::shared_ptr<const AnimationSet> set);

    /// A set with the same skeleton, skins, morphs and masks but other clips, for example with markers (see
    /// Clip::withMarkers). Its palette is the same, so the meshes of this set fit it. Errors: those of create().
    Result<std::shared_ptr<const AnimationSet>> withClips(std::vector<Clip> clips) const;

    /// A set with the same skeleton, skins, morphs, masks and clips but these constraints, solved in this order. Its
    /// palette is the same, so the meshes of this set fit it. Errors: a joint that does not exist; joints of a chain
    /// that are no descendants of each other; a chain of more than 12 joints; numbers that are not finite or out of
    /// range; axes that are 0 or parallel; a limb that is straight at rest and has no hinge; two equal names; more than
    /// maxConstraints.
    Result<std::shared_ptr<const AnimationSet>> withConstraints(std::vector<Constraint> constraints) const;

    /// A set with the same skeleton, skins, morphs, masks, clips and constraints but these garments: joints with the
    /// inverse binds of meshes from other files. Each takes a palette entry of its own, after all others, so the meshes
    /// of this set fit the new one. Sets are shared: while another one with these garments exists that was made of the
    /// same set, the call returns that one. AnimatedCharacter::wear() calls it. Errors: as for skins in create().
    Result<std::shared_ptr<const AnimationSet>> withGarments(std::vector<Skin> garments) const;

    const Skeleton& skeleton() const { return _parts.skeleton; }                      ///< the joints
    const std::vector<Skin>& skins() const { return _parts.skins; }                   ///< as passed to create()
    const std::vector<int>& rigidJoints() const { return _parts.rigidJoints; }        ///< as passed to create()
    const std::vector<MorphWeights>& morphs() const { return _parts.morphs; }         ///< as passed to create()
    const std::vector<Clip>& clips() const { return _parts.clips; }                   ///< as passed to create()
    const std::vector<Constraint>& constraints() const { return _parts.constraints; } ///< as passed to create()
    const std::vector<Skin>& garments() const { return _parts.garments; }             ///< as passed to withGarments()
    /// The constraints after the look-up of their joints, for the kit's own code.
    const std::vector<ConstraintChain>& constraintChains() const { return *_constraintChains; }
    /// The index of the constraint of that name. Error: there is none; the message lists the existing names.
    Result<std::size_t> constraintNamed(const std::string& name) const;

    std::size_t trackCount() const { return _restPose.size(); }               ///< joints, then weight blocks
    const std::vector<JointTransform>& restPose() const { return _restPose; } ///< trackCount() transforms
    /// The track of the morph's first weight block. morph: below morphs().size().
    std::size_t firstTrackOfMorph(std::size_t morph) const { return _firstTracksOfMorphs[morph]; }

    /// In the order of the levels; the entries of garments come last.
    const std::vector<PaletteEntry>& palette() const { return _layout.entries; }
    std::size_t paletteSize() const { return _layout.entries.size(); } ///< number of entries
    /// levelCount() + 1 entry indices: level l is [levels()[l], levels()[l + 1]). The last one is the first entry of
    /// the garments, which belong to no level.
    const std::vector<std::size_t>& levels() const { return _layout.levels; }
    std::size_t levelCount() const { return _layout.levels.size() - 1; } ///< number of levels of the palette

    /// The palette entry of the joint at an index of Skin::joints.
    int entryOfSkin(std::size_t skin, std::size_t place) const { return _layout.entryOfSkin[skin][place]; }
    /// The palette entries of all joints of a skin, in the order of Skin::joints.
    const std::vector<int>& entriesOfSkin(std::size_t skin) const { return _layout.entryOfSkin[skin]; }
    /// The entry with an identity inverse bind for a joint that carries a rigid mesh; -1 for other joints.
    int entryOfRigidJoint(int joint) const;
    /// The joint's main entry; jointToModel = entry · (that entry's inverseBind)⁻¹.
    int mainEntry(int joint) const { return _layout.mainEntry[joint]; }
    /// The entry of a morph's first weight block; the others follow it. -1 without weights and for properties.
    int entryOfMorph(std::size_t morph) const { return _layout.entryOfMorph[morph]; }

    /// The first clip of that name; -1 if there is none.
    int findClip(const std::string& name) const;
    /// The index of the first clip of that name. Error: there is no such clip; the message lists the existing names.
    Result<std::size_t> clipNamed(const std::string& name) const;
    Result<std::size_t> clipAt(std::size_t clip) const; ///< The index itself, if it is below clips().size().

    /// The number of a clip's first keyframe. Number 0 is the rest pose, then come the keyframes of all clips in turn
    /// (see BlendSample::keyframe).
    std::size_t firstKeyframe(std::size_t clip) const { return _firstKeyframes[clip]; }
    std::size_t keyframeCount() const { return _keyframeCount; } ///< of the rest pose and all clips
    /// A blend sample of weight 1. clip: below clips().size(); negative for the rest pose. time: seconds on the time
    /// line of the clip.
    BlendSample sampleAt(int clip, double time) const;

    /// The mask with these weights, for as long as the caller holds it; equal masks are one. Safe to call from several
    /// threads. weights: one per track, in [0, 1], see JointMask::weights().
    /// Errors: a wrong number of weights; MaskTable::maxMasks masks exist.
    Result<std::shared_ptr<const SetMask>> useMask(const std::vector<float>& weights) const;
    const MaskTable& masks() const { return *_masks; } ///< the masks of this set

    /// The value that keepGroundSpeed() was called with; empty: not measured yet. See measureGroundSpeed().
    std::optional<double> knownGroundSpeed(std::size_t clip) const;
    /// Keeps a measured value. Safe to call from several threads. clip: below clips().size().
    void keepGroundSpeed(std::size_t clip, double speed) const;

private:
    struct Family;

    AnimationSet(AnimationParts parts, std::shared_ptr<MaskTable> masks, std::shared_ptr<Family> family,
                 std::shared_ptr<const std::vector<ConstraintChain>> constraintChains);
    static Result<std::shared_ptr<const AnimationSet>> make(AnimationParts parts, std::shared_ptr<MaskTable> masks,
                                                            std::shared_ptr<Family> family = nullptr);

    AnimationParts _parts;
    std::vector<JointTransform> _restPose;
    std::vector<std::size_t> _firstTracksOfMorphs; ///< and at the end the number of tracks
    PaletteLayout _layout;
    std::shared_ptr<const std::vector<ConstraintChain>> _constraintChains; ///< never null
    std::vector<std::size_t> _firstKeyframes;
    std::size_t _keyframeCount = 1;
    std::shared_ptr<MaskTable> _masks; ///< shared by sets with equal tracks
    std::shared_ptr<Family> _family;   ///< never null
    mutable std::mutex _groundSpeedMutex;
    mutable std::vector<double> _groundSpeeds; ///< by clip; NaN: not measured yet
};

} // namespace osgGpuAnimation
