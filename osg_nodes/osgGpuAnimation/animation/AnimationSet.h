// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/MaskTable.h>
#include <osgGpuAnimation/animation/MorphWeights.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>
#include <osgGpuAnimation/animation/Result.h>
#include <osgGpuAnimation/animation/Skeleton.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

class JointMask;

/// Joints with their inverse bind matrices (glTF 2.0, section 3.7.3).
struct Skin
{
    std::string name;
    std::vector<int> joints;                ///< joints of the skeleton
    std::vector<AffineMatrix> inverseBinds; ///< one a joint: from the mesh's space at bind time to the joint's
};

/// One joint with one inverse bind matrix, or one block of morph weights: what the GPU computes 48 bytes for.
///
/// Entries are stored in level order, a level after the other, and each is computed from its parent's *entry*, so that
/// only one 3x4 matrix a joint has to be written and read on the GPU:
///
///     entry = parentEntry · parentBind · T·R·S · inverseBind        parentBind = (the parent entry's inverseBind)⁻¹
///
/// Every joint has one main entry. A joint that several skins bind differently, or that carries a rigid mesh besides
/// being skinned, has further entries: children of the main one, without a track of their own.
///
/// The main entry takes the inverse bind matrix of the first skin that names the joint, if that matrix can be undone
/// without loss (see AnimationSet.cpp), else the identity; equal matrices of one joint share an entry.
struct PaletteEntry
{
    enum class Kind
    {
        Joint,   ///< T·R·S from the track
        Static,  ///< no track: T·R·S = identity
        Weights, ///< the track's twelve numbers as they are; no parent, no matrices
    };

    Kind kind = Kind::Joint;
    int joint = -1;           ///< the joint it belongs to; -1 for weights
    int parent = -1;          ///< an entry of an earlier level; -1: the instance's root matrix
    int track = -1;           ///< place in a keyframe; -1 for Static
    AffineMatrix parentBind;  ///< from the parent entry's joint to the model at bind time
    AffineMatrix inverseBind; ///< from the model at bind time to this joint
};

/// What AnimationSet::create takes.
struct AnimationParts
{
    Skeleton skeleton;
    std::vector<Skin> skins;
    std::vector<int> rigidJoints; ///< joints that carry a mesh without a skin
    std::vector<MorphWeights> morphs;
    std::vector<Clip> clips; ///< made by ClipBuilder on the same skeleton and morphs
};

/// Skeleton, palette and clips of one kind of character: immutable and shared by all its instances, on the CPU and,
/// once a context, on the GPU. A **track** is one JointTransform in every keyframe: the joints', then the weight
/// blocks'.
class AnimationSet
{
public:
    /// Errors: a skin or rigid joint out of range, a skin with fewer matrices than joints, a matrix or default weight
    /// that is not finite, a clip with a wrong number of tracks, more keyframes than 32-bit offsets reach.
    static Result<std::shared_ptr<const AnimationSet>> create(AnimationParts parts);

    /// The same skeleton, skins, morphs and masks with other clips: with markers, say, see Clip::withMarkers. What a
    /// mesh knows of this set (palette entries) holds for that one too.
    /// Errors: those of create().
    Result<std::shared_ptr<const AnimationSet>> withClips(std::vector<Clip> clips) const;

    const Skeleton& skeleton() const { return _parts.skeleton; }
    const std::vector<Skin>& skins() const { return _parts.skins; }
    const std::vector<int>& rigidJoints() const { return _parts.rigidJoints; } ///< as they were given
    const std::vector<MorphWeights>& morphs() const { return _parts.morphs; }
    const std::vector<Clip>& clips() const { return _parts.clips; }

    std::size_t trackCount() const { return _restPose.size(); }
    const std::vector<JointTransform>& restPose() const { return _restPose; } ///< trackCount() transforms
    std::size_t firstTrackOfMorph(std::size_t morph) const { return _firstTrackOfMorph[morph]; }

    const std::vector<PaletteEntry>& palette() const { return _palette; }
    std::size_t paletteSize() const { return _palette.size(); }
    /// levelCount() + 1 entry indices: level l is [levels()[l], levels()[l + 1]).
    const std::vector<std::size_t>& levels() const { return _levels; }
    std::size_t levelCount() const { return _levels.size() - 1; }

    /// The entry a vertex names for that place in the skin's joints.
    int entryOfSkin(std::size_t skin, std::size_t place) const { return _entryOfSkin[skin][place]; }
    /// The entries of all places of a skin's joints, in their order: skins with equal ones move vertices alike.
    const std::vector<int>& entriesOfSkin(std::size_t skin) const { return _entryOfSkin[skin]; }
    /// The entry with an identity inverse bind of a rigid joint; -1 if it is not one.
    int entryOfRigidJoint(int joint) const;
    /// The joint's main entry; jointToModel = entry · (that entry's inverseBind)⁻¹.
    int mainEntry(int joint) const { return _mainEntry[static_cast<std::size_t>(joint)]; }
    /// The first entry of a morph's weight blocks; the others follow it. -1 where it has no weights.
    int entryOfMorph(std::size_t morph) const { return _entryOfMorph[morph]; }

    /// -1 where there is none. Of several clips of one name, the first.
    int findClip(const std::string& name) const;
    /// The clip of that name or number, or an error that lists the names there are.
    Result<std::size_t> clipNamed(const std::string& name) const;
    Result<std::size_t> clipAt(std::size_t clip) const;

    /// All keyframes of the set are numbered: 0 is the rest pose, then clip after clip (see BlendSample::keyframe).
    std::size_t firstKeyframe(std::size_t clip) const { return _firstKeyframes[clip]; }
    std::size_t keyframeCount() const { return _keyframeCount; } ///< the rest pose and those of all clips
    /// The clip at that time (seconds on its own time line) as a sample of full weight. clip -1: the rest pose.
    BlendSample sampleAt(int clip, double time) const;

    /// Takes a mask up for all layers that are to use it, and returns its number (see BlendSample::control). Masks are
    /// only ever added, so a set that is in use can take more; equal ones are stored once.
    /// Errors: the mask has not one weight a track of this set; MaskTable::maxMasks are there already.
    Result<std::uint32_t> addMask(const JointMask& mask) const;
    const MaskTable& masks() const { return _masks; }

private:
    AnimationSet(AnimationParts parts, const MaskTable& masks);
    static Result<std::shared_ptr<const AnimationSet>> make(AnimationParts parts, const MaskTable& masks);

    AnimationParts _parts;
    std::vector<JointTransform> _restPose;
    std::vector<std::size_t> _firstTrackOfMorph;
    std::vector<PaletteEntry> _palette;
    std::vector<std::size_t> _levels;
    std::vector<std::vector<int>> _entryOfSkin;
    std::vector<int> _entryOfRigidJoint;
    std::vector<int> _mainEntry;
    std::vector<int> _entryOfMorph;
    std::vector<std::size_t> _firstKeyframes;
    std::size_t _keyframeCount = 1;
    mutable MaskTable _masks;
};

} // namespace osgGpuAnimation
