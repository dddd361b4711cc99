// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/AnimationBuffers.h>

#include <layout.glsl>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using PackedEntry = std::array<glm::vec4, POSE_TEXELS_PER_ENTRY>;

PackedEntry packed(const PaletteEntry& entry)
{
    PackedEntry out;
    out[0] = glm::vec4(entry.parent, entry.track, entry.kind == PaletteEntry::Kind::Weights, 0);
    for (std::size_t row = 0; row < 3; ++row)
    {
        out[1 + row] = entry.parentBind.rows[row];
        out[4 + row] = entry.inverseBind.rows[row];
    }
    return out;
}

} // namespace

AnimationBuffers::AnimationBuffers(osg::GLExtensions& gl, const AnimationSet& set)
    : _keyframes(gl, GL_RGBA32F_ARB), _entries(gl, GL_RGBA32F_ARB), _masks(gl, GL_RGBA32F_ARB)
{
    const std::vector<JointTransform> keyframes = set.keyframeBuffer();
    _keyframes.upload(keyframes.data(), keyframes.size() * sizeof(JointTransform));

    std::vector<PackedEntry> entries;
    entries.reserve(set.paletteSize());
    for (const PaletteEntry& entry : set.palette())
        entries.push_back(packed(entry));
    _entries.upload(entries.data(), entries.size() * sizeof(PackedEntry));
}

std::size_t AnimationBuffers::texelsPerMask(const AnimationSet& set)
{
    return (set.trackCount() + POSE_WEIGHTS_PER_MASK_TEXEL - 1) / POSE_WEIGHTS_PER_MASK_TEXEL;
}

void AnimationBuffers::updateMasks(const AnimationSet& set)
{
    const std::size_t count = set.masks().count();
    if (count == _maskCount) return;
    const std::size_t stride = texelsPerMask(set) * POSE_WEIGHTS_PER_MASK_TEXEL;
    std::vector<float> weights((count + 1) * stride, 1.0f);
    for (std::size_t mask = 1; mask <= count; ++mask)
    {
        const float* from = set.masks().weights(static_cast<std::uint32_t>(mask));
        std::copy(from, from + set.trackCount(), weights.begin() + static_cast<std::ptrdiff_t>(mask * stride));
    }
    _masks.upload(weights.data(), weights.size() * sizeof(float));
    _maskCount = count;
}

void AnimationBuffers::release()
{
    _keyframes.release();
    _entries.release();
    _masks.release();
}

void AnimationBuffers::discard()
{
    _keyframes.discard();
    _entries.discard();
    _masks.discard();
}

std::size_t AnimationBuffers::byteSize(const AnimationSet& set)
{
    return set.keyframeBufferSize() * sizeof(JointTransform) + set.paletteSize() * sizeof(PackedEntry);
}

} // namespace osgGpuAnimation
