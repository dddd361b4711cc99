// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/MorphTarget.h>

#include <osg/State>
#include <osg/TextureBuffer>

#include <array>
#include <vector>

namespace osgGpuAnimation
{

/// Morph targets packed into the buffer texture of skin.glsl.
struct MorphDeltas
{
    osg::ref_ptr<osg::TextureBuffer> texture; ///< RGBA32F: by vertex, target, channel
    /// The number of channels per target, then the indices of normal, colour, texture coordinate and tangent (-1:
    /// none). Position is always channel 0.
    std::array<int, 5> channels{1, -1, -1, -1, -1};
};

/// Packs the targets. Targets with the same arrays share one texture while it is in use, so that one mesh under many
/// nodes is packed once. After a change to an array call its dirty(), as usual in OSG. Thread-safe.
MorphDeltas packMorphTargets(const std::vector<MorphTarget>& targets, std::size_t vertexCount);

/// Binds the texture and sets the uniforms of the applied program. entry: the first palette entry of the weights.
/// False: the texture exceeds the context's limit, and the program draws without targets.
bool bindMorphTargets(osg::State& state, const MorphDeltas& deltas, std::size_t targetCount, int entry);

} // namespace osgGpuAnimation
