// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/MorphTarget.h>

#include <osg/State>
#include <osg/TextureBuffer>

#include <array>
#include <vector>

namespace osgGpuAnimation
{

/// Morph targets as the buffer texture that skin.glsl reads.
struct MorphDeltas
{
    osg::ref_ptr<osg::TextureBuffer> texture; ///< RGBA32F: by vertex, target, channel
    /// Channels a target has, then the places of normal, colour and texture coordinate among them (-1: it has none);
    /// position is always the first.
    std::array<int, 4> channels{1, -1, -1, -1};
};

/// Targets of the same arrays as others that are still in use share their texture with them, so that one mesh under
/// many nodes is packed once. Arrays that change are to be dirty()ed, as everywhere in OSG. Any thread may call it.
MorphDeltas packMorphTargets(const std::vector<MorphTarget>& targets, std::size_t vertexCount);

/// Binds them for the program that is applied. entry: the first palette entry of the weights. False where they are more
/// than the context's buffer textures take: the program is told that there are none.
bool bindMorphTargets(osg::State& state, const MorphDeltas& deltas, std::size_t targetCount, int entry);

} // namespace osgGpuAnimation
