// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationParts.h>
#include <osgGpuAnimation/animation/PaletteEntry.h>

namespace osgGpuAnimation
{

/// Finds the inverse bind matrices that each joint needs, chooses the main entry of each joint and sorts all entries by
/// level. The garments' entries come after all levels, one for each of their inverse binds. All indices must be valid
/// and all numbers finite: AnimationSet::create() checks them.
PaletteLayout layOutPalette(const AnimationParts& parts);

} // namespace osgGpuAnimation
