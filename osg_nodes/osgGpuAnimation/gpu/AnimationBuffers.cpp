// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/AnimationBuffers.h>

#include <layout.glsl>

#include <array>
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
    : _keyframes(gl, GL_RGBA32F_ARB), _entries(gl, GL_RGBA32F_ARB)
{
    const std::vector<JointTransform> keyframes = set.keyframeBuffer();
    _keyframes.upload(keyframes.data(), keyframes.size() * sizeof(JointTransform));

    std::vector<PackedEntry> entries;
    entries.reserve(set.paletteSize());
    for (const PaletteEntry& entry : set.palette())
        entries.push_back(packed(entry));
    _entries.upload(entries.data(), entries.size() * sizeof(PackedEntry));
}

void AnimationBuffers::release()
{
    _keyframes.release();
    _entries.release();
}

void AnimationBuffers::discard()
{
    _keyframes.discard();
    _entries.discard();
}

std::size_t AnimationBuffers::byteSize(const AnimationSet& set)
{
    return set.keyframeBufferSize() * sizeof(JointTransform) + set.paletteSize() * sizeof(PackedEntry);
}

} // namespace osgGpuAnimation
