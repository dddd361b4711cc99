// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/PosePalette.h>

#include <osg/State>

namespace osgGpuAnimation
{

/// Sets the uniforms by which skin.glsl finds the palette and the tints in the program that is applied.
/// influences: of a vertex, at most. rigidEntry: the entry that moves all vertices; -1: influences are per vertex.
void bindPalette(osg::State& state, const PalettePlace& place, int influences, int rigidEntry);

} // namespace osgGpuAnimation
