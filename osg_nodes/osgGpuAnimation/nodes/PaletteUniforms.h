// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/PosePalette.h>

#include <osg/State>

namespace osgGpuAnimation
{

class SkinnedGeometry;

/// Tells the program that is applied where skin.glsl finds the palette, the tints and the mesh's morph targets. False
/// where the targets are more than the context's buffer textures take: the mesh is drawn unmorphed.
bool bindPalette(osg::State& state, const SkinnedGeometry& mesh, const PalettePlace& place);

} // namespace osgGpuAnimation
