// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>
#include <osgGpuAnimation/gpu/buffers/ConstraintBuffers.h>

#include <map>
#include <memory>
#include <vector>

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
    bool isModest() const { return _isModest; } ///< see hasModestPalette()
    /// RGBA32F: set.paletteSize() entries of POSE_TEXELS_PER_ENTRY texels.
    const BufferTexture& entries() const { return _entries; }

    /// RGBA32F: masks of texelsPerMask texels each, by number; mask 0 is all 1. See updateMasks().
    const BufferTexture& masks() const { return _masks; }
    static std::size_t texelsPerMask(const AnimationSet& set);
    /// Uploads the masks if one of them is new. masks: by number, see PoseBatch::masks().
    void updateMasks(const AnimationSet& set, const std::vector<std::shared_ptr<const SetMask>>& masks);

    /// The data for these constraints of the set, made at the first call. active: bit c for constraint c, not 0.
    /// Valid until the next call.
    const ConstraintBuffers& constraints(const AnimationSet& set, std::uint64_t active);

    /// Bytes of the buffers without masks and constraints.
    static std::size_t byteSize(const AnimationSet& set, const PackedKeyframes& keyframes);

    void release();

private:
    osg::GLExtensions* _gl;
    std::size_t _restTexel;
    std::vector<PackedKeyframes::Track> _levels;
    PackedKeyframes::Track _anyTrack;
    bool _isModest;
    BufferTexture _keyframes;
    BufferTexture _entries;
    BufferTexture _masks;
    std::vector<float> _maskWeights;                                          ///< content of _masks
    std::vector<std::weak_ptr<const SetMask>> _uploadedMasks;                 ///< by number
    std::map<std::uint64_t, std::unique_ptr<ConstraintBuffers>> _constraints; ///< by active
};

} // namespace osgGpuAnimation
