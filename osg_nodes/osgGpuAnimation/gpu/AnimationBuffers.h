// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/gpu/BufferTexture.h>

namespace osgGpuAnimation
{

/// What all instances of a set share on the GPU, in one graphics context: uploaded once.
class AnimationBuffers
{
public:
    AnimationBuffers(osg::GLExtensions& gl, const AnimationSet& set);

    /// RGBA32F: set.keyframeBufferSize() joint transforms, three texels each.
    const BufferTexture& keyframes() const { return _keyframes; }
    /// RGBA32F: set.paletteSize() entries of POSE_TEXELS_PER_ENTRY texels.
    const BufferTexture& entries() const { return _entries; }

    void release();
    void discard();

    static std::size_t byteSize(const AnimationSet& set);

private:
    BufferTexture _keyframes;
    BufferTexture _entries;
};

} // namespace osgGpuAnimation
