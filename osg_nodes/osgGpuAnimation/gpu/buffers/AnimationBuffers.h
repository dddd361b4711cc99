// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>

namespace osgGpuAnimation
{

/// What all instances of a set share on the GPU, in one graphics context: uploaded once.
class AnimationBuffers
{
public:
    AnimationBuffers(osg::GLExtensions& gl, const AnimationSet& set, const PackedKeyframes& keyframes);

    /// RGBA32UI: the texels of a PackedKeyframes.
    const BufferTexture& keyframes() const { return _keyframes; }
    std::size_t restTexel() const { return _restTexel; } ///< see PackedKeyframes
    /// What moves in a level of the palette: one a level of the set.
    const std::vector<PackedKeyframes::Track>& levels() const { return _levels; }
    /// What moves in any track.
    const PackedKeyframes::Track& anyTrack() const { return _anyTrack; }
    /// RGBA32F: set.paletteSize() entries of POSE_TEXELS_PER_ENTRY texels.
    const BufferTexture& entries() const { return _entries; }

    /// RGBA32F: masks().count() + 1 masks of texelsPerMask texels each, mask 0 being all 1. See updateMasks().
    const BufferTexture& masks() const { return _masks; }
    static std::size_t texelsPerMask(const AnimationSet& set);
    /// Uploads the set's masks if it has more than last time.
    void updateMasks(const AnimationSet& set);

    /// Without masks.
    static std::size_t byteSize(const AnimationSet& set, const PackedKeyframes& keyframes);

    void release();
    void discard();

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
