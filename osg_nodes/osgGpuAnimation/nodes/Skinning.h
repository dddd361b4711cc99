// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// When the vertices of a SkinnedGeometry are skinned.
enum class Skinning
{
    Auto,      ///< once a frame where that is cheaper, as far as can be told: see SkinningPlan
    EveryDraw, ///< by each draw, as often as the mesh is drawn
    Once,      ///< once a frame for all cameras and passes, into a buffer on the GPU
};

} // namespace osgGpuAnimation
