// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>

namespace osgGpuAnimation
{

/// The GPU data that all instances of a set share, in one graphics context. The constructor uploads it.
class AnimationBuffers
{
public:
    AnimationBuffers(osg::GLExtensions& gl, const AnimationSet& set, const PackedKeyframes& keyframes);

    /// RGBA32UI: the texels of a PackedKeyframes.
    const BufferTexture& keyframes() const { return _keyframes; }
    std::size_t restTexel() const { return _restTexel; } ///< see PackedKeyframes
    /// The moving parts of each level of the palette.
    const std::vector<PackedKeyframes::Track>& levels() const { return _levels; }
    /// The moving parts of all tracks together.
    const PackedKeyframes::Track& anyTrack() const { return _anyTrack; }
    /// RGBA32F: set.paletteSize() entries of POSE_TEXELS_PER_ENTRY texels.
    const BufferTexture& entries() const { return _entries; }

    /// RGBA32F: masks().count() + 1 masks of texelsPerMask texels each; mask 0 is all 1. See updateMasks().
    const BufferTexture& masks() const { return _masks; }
    static std::size_t texelsPerMask(const AnimationSet& set);
    /// Uploads the set's masks if it has more than at the last call.
    void updateMasks(const AnimationSet& set);

    /// Bytes of the buffers without masks.
    static std::size_t byteSize(const AnimationSet& set, const PackedKeyframes& keyframes);

    void release();

private:
    std::size_t _restTexel;
    std::vector<PackedKeyframes::Track> _levels;
    PackedKeyframes::Track _anyTrack;
    BufferTexture _keyframes;
    BufferTexture _entries;
    BufferTexture _masks;
    std::size_t _maskCount = 0; ///< of the set's masks, in _masks
};

} // namespace osgGpuAnimation
