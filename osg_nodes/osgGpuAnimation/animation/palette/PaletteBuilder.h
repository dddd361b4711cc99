// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/PaletteEntry.h>
#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/animation/Skin.h>

#include <vector>

namespace osgGpuAnimation
{

/// Finds the inverse bind matrices that each joint needs, chooses the main entry of each joint and sorts all entries by
/// level. The garments' entries come after all levels, one for each of their inverse binds. All indices must be valid
/// and all numbers finite: AnimationSet::create() checks them.
PaletteLayout layOutPalette(const Skeleton& skeleton, const std::vector<Skin>& skins,
                            const std::vector<int>& rigidJoints, const std::vector<MorphWeights>& morphs,
                            const std::vector<Skin>& garments);

} // namespace osgGpuAnimation
