// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/Constraint.h>
#include <osgGpuAnimation/animation/PaletteEntry.h>
#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/math/Result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Two neighbouring keyframes and how to mix them: the 16 bytes that the GPU gets for one clip of one character.
/// Additive layers take two samples: their reference, then the sample itself.
struct BlendSample
{
    /// the first keyframe, see AnimationSet::firstKeyframe(); 0: the rest pose; POSE_SAMPLE_POSED: an index of
    /// PoseInstruction::poses
    std::uint32_t keyframe = 0;
    float alpha = 0.0f;        ///< share of the second keyframe, in [0, 1)
    float weight = 1.0f;       ///< in [0, 1]; negative values and NaN count as 0
    std::uint32_t control = 0; ///< bits of layout.glsl: POSE_SAMPLE_SPLINE …, and the number of the mask << 16
};

static_assert(sizeof(BlendSample) == 16, "a blend sample is 16 bytes on the GPU");

class JointPose;

/// The blend samples of one character in one frame: the GPU mixes them to the character's pose. Default: the rest pose.
///
/// The mix, joint by joint (shaders/mix.glsl and its CPU twin Pose):
/// - The weight of a sample at a joint is its own weight times the weight of its mask.
/// - Samples are grouped into **blend priorities**, from the bottom up; POSE_SAMPLE_ABOVE begins the next blend
///   priority. Samples of one blend priority share the joint by their weights: a sum above 1 is scaled to 1. If the
///   weights sum to less than 1, the blend priorities below fill the remainder; the rest pose comes last.
/// - Translations, scales and morph weights are summed. Rotations are summed as unit quaternions on one hemisphere and
///   normalized: within a blend priority the hemisphere of its first sample with a weight at the joint; the sum of a
///   blend priority takes the hemisphere of the blend priorities below. Controllers put the heaviest sample first, so
///   the order of layers does not matter, no two samples cancel out, and a sample that fades in never reverses the
///   visible one. (The hemisphere of the rest pose would be simpler, but two nearly equal poses half a turn away from
///   rest would cancel out.)
/// - Additive samples come last; their order does not matter. With d = R_reference⁻¹ · R, rotations are multiplied by
///   exp(Σ weight · log d), with the sum limited to a full turn; translations get Σ weight · (T − T_reference); scales
///   are multiplied by Π (1 + weight · (S / S_reference − 1)), except on axes with a reference of 0.
/// - A posed sample (POSE_SAMPLE_POSED) has no weight at the parts of joints and the morph weights that are not set in
///   its pose.
struct PoseInstruction
{
    static constexpr std::size_t maxSamples = 16; ///< the maximum number of samples of one pose

    std::size_t sampleCount = 1;                 ///< [1, maxSamples]
    std::array<BlendSample, maxSamples> samples; ///< only the first sampleCount are used
    /// The poses of the posed samples. They change with their layers; whoever keeps a pose for later takes its
    /// JointPose::sharedKeyframe(). A null pose, or one with another number of tracks than the set, shows nothing.
    std::vector<std::shared_ptr<const JointPose>> poses{};
    /// One per constraint of the set, solved in this order after the mix; empty: none has an effect.
    std::vector<ConstraintTarget> targets{};
};

struct ConstraintChain;
struct Box;
/// For each palette entry, the box of the vertices that it moves, in the mesh's space at bind time.
using EntryBoxes = std::vector<Box>;

/// The weights of a mask, see JointMask. It exists as long as somebody holds it: the layers with this mask, and frames
/// until they are drawn.
struct SetMask
{
    std::uint32_t number;       ///< from 1 on, see BlendSample::control; unique among the masks that exist
    std::vector<float> weights; ///< one per track, in [0, 1]
};

/// The masks of one AnimationSet by number. Safe to use from several threads.
class MaskTable
{
public:
    static constexpr std::size_t maxMasks = 4096; ///< the maximum number of masks that exist at one time

    /// The mask with these weights. Creates it if it is new. Null: maxMasks masks exist.
    std::shared_ptr<const SetMask> use(const std::vector<float>& weights);
    /// The table holds the mask as long as it exists itself. mask: of use().
    void keep(const std::shared_ptr<const SetMask>& mask);

    std::size_t count() const; ///< number of masks that exist
    /// Null for 0 (no mask) and for numbers without a mask.
    std::shared_ptr<const SetMask> find(std::uint32_t number) const;
    /// The weights of a mask, one per track, valid while the mask exists. Null as for find().
    const float* weights(std::uint32_t number) const;

private:
    mutable std::mutex _mutex;
    std::vector<std::weak_ptr<const SetMask>> _masks; ///< by number - 1; expired: the number is free
    std::vector<std::shared_ptr<const SetMask>> _kept;
};

/// The input of AnimationSet::create().
struct AnimationParts
{
    Skeleton skeleton;                     ///< the joints
    std::vector<Skin> skins;               ///< skins of the meshes
    std::vector<int> rigidJoints;          ///< joints that carry a mesh without a skin
    std::vector<MorphWeights> morphs;      ///< meshes with morph weights
    std::vector<Clip> clips;               ///< created for the same skeleton and morphs
    std::vector<Constraint> constraints{}; ///< in the order in which they are solved
    std::vector<Skin> garments{};          ///< inverse binds of meshes from other files, see withGarments()
};

class AnimationSet;

/// The result of AnimationSet::withClipsOf().
struct RetargetedSet
{
    std::shared_ptr<const AnimationSet> set; ///< never null; its last clips are the new ones
    /// Joints and morphs of the set that have no counterpart: the new clips leave them at rest.
    std::vector<std::string> atRest;
    /// Joints and morphs that the other set's clips move and that have no counterpart in the set.
    std::vector<std::string> leftOut;
};

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

    ~AnimationSet();

    /// The set; if it is null, a set without joints and clips, which characters and crowds have before they get one.
    static std::shared_ptr<const AnimationSet> orEmpty(std::shared_ptr<const AnimationSet> set);

    /// A set with the same skeleton, skins, morphs and masks but other clips, for example with markers (see
    /// Clip::withMarkers). Its palette is the same, so the meshes of this set fit it. Errors: those of create().
    Result<std::shared_ptr<const AnimationSet>> withClips(std::vector<Clip> clips) const;

    /// A set with the same skeleton, skins, morphs and masks, with the clips of this set and then those of another one:
    ///
    ///     auto result = knight->getAnimationSet().withClipsOf(*general);
    ///     if (result) set = result.value().set; // for AnimatedCharacter::setAnimationSet()
    ///
    /// Joints and morphs are matched by name, see RetargetOptions. Where their rest poses agree, the clips are copied
    /// bit by bit. Elsewhere rotations keep their difference from the rest pose in model space (derived at
    /// ClipRetargeter), so both characters must face the same way at rest. The hips and the joints above them move by
    /// the ratio of the hip heights, which is that of the legs; at each keyframe the hips are shifted along +Y, so that
    /// the body's height above the ground is that of the clip times the ratio. Other translations are those of this
    /// set's rest pose; factors of the rest scale are kept. What has no counterpart keeps its rest pose. Times, markers
    /// and morph weights are copied. A name that this set's clips have gets a number: `Idle 2`. The new clips are
    /// exact: compact ones may be compacted again (see compactClips()).
    ///
    /// Errors: the other set has no clips; neither a joint nor a morph has a counterpart; a name in the options does
    /// not exist; root motion was removed from a clip (see withRootMotion()) whose joint has another rest pose; errors
    /// of create().
    Result<RetargetedSet> withClipsOf(const AnimationSet& other, const RetargetOptions& options = {}) const;

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
    int mainEntry(int joint) const { return _layout.mainEntry[static_cast<std::size_t>(joint)]; }
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
    /// The same for a mask that exists as long as the set. Returns its number, from 1 on (see BlendSample::control).
    Result<std::uint32_t> addMask(const std::vector<float>& weights) const;
    const MaskTable& masks() const { return *_masks; } ///< the masks of this set

    /// The value that keepGroundSpeed() was called with; empty: not measured yet. See measureGroundSpeed().
    std::optional<double> knownGroundSpeed(std::size_t clip) const;
    /// Keeps a measured value. Safe to call from several threads. clip: below clips().size().
    void keepGroundSpeed(std::size_t clip, double speed) const;

private:
    struct Family;

    AnimationSet(AnimationParts parts, std::shared_ptr<MaskTable> masks, std::shared_ptr<Family> family,
                 std::shared_ptr<const std::vector<ConstraintChain>> constraintChains);
    static Result<std::shared_ptr<const AnimationSet>> make(AnimationParts parts, std::shared_ptr<MaskTable> masks);
    static Result<std::shared_ptr<const AnimationSet>> make(AnimationParts parts, std::shared_ptr<MaskTable> masks,
                                                            const std::shared_ptr<Family>& family);

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
