// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/AffineMatrix.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// One joint with one inverse bind matrix, or one block of morph weights. The GPU computes 48 bytes for each entry.
///
/// Entries are stored level by level. The GPU computes each entry from its parent's *entry*, so that it writes and
/// reads a single 3x4 matrix per joint:
///
///     entry = parentEntry · parentBind · T·R·S · inverseBind        parentBind = (the parent entry's inverseBind)⁻¹
///
/// Every joint has one main entry. A joint has further entries if several skins bind it differently or if it is skinned
/// and also carries a rigid mesh. Further entries are children of the main entry and have no track. Those of garments
/// come after all levels (see AnimationSet::withGarments()).
///
/// The main entry takes the inverse bind matrix of the first skin that contains the joint if that matrix can be
/// inverted without loss (see PaletteBuilder.cpp), else the identity. Equal matrices of one joint share an entry.
struct PaletteEntry
{
    /// The source of an entry's values.
    enum class Kind
    {
        Joint,   ///< T·R·S comes from the track
        Static,  ///< no track: T·R·S is the identity
        Weights, ///< the track's twelve numbers unchanged; no parent, no matrices
    };

    Kind kind = Kind::Joint;  ///< the source of the values
    int joint = -1;           ///< the joint of the entry; -1 for weights
    int parent = -1;          ///< an entry of an earlier level; -1: the instance's root matrix
    int track = -1;           ///< index in a keyframe; -1 for Static
    AffineMatrix parentBind;  ///< from the space of the parent entry's joint to the model at bind time
    AffineMatrix inverseBind; ///< from the model at bind time to joint space
};

/// All palette entries of an AnimationSet and how to find them.
struct PaletteLayout
{
    std::vector<PaletteEntry> entries;         ///< level by level, then those of garments
    std::vector<std::size_t> levels;           ///< level count + 1 entry indices: level l is [levels[l], levels[l + 1])
    std::vector<std::vector<int>> entryOfSkin; ///< by skin, then by index in Skin::joints
    std::vector<int> entryOfRigidJoint;        ///< by joint; -1 if no rigid mesh hangs on the joint
    std::vector<int> mainEntry;                ///< by joint
    std::vector<int> entryOfMorph; ///< by morph: its first weight block; -1 without weights and for properties
};

} // namespace osgGpuAnimation
