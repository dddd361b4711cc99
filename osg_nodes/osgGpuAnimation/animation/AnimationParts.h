// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/Constraint.h>
#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/animation/Skin.h>

#include <vector>

namespace osgGpuAnimation
{

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

} // namespace osgGpuAnimation
