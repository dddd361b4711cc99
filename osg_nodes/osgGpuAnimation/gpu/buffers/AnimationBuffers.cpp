// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/buffers/AnimationBuffers.h>

#include <osgGpuAnimation/animation/bounds/TransformBound.h>

#include <layout.glsl>

#include <algorithm>
#include <array>
#include <cstdint>

namespace osgGpuAnimation
{

namespace
{

using PackedEntry = std::array<glm::vec4, POSE_TEXELS_PER_ENTRY>;

PackedEntry packed(const PaletteEntry& entry, const std::vector<JointTransform>& restPose)
{
    PackedEntry out{};
    out[0] = glm::vec4(entry.parent, entry.track, entry.kind == PaletteEntry::Kind::Weights, 0);
    for (std::size_t row = 0; row < 3; ++row)
    {
        out[1 + row] = limited(entry.parentBind.rows[row]);
        out[4 + row] = limited(entry.inverseBind.rows[row]);
    }
    if (entry.track < 0) return out;
    const JointTransform& rest = restPose[static_cast<std::size_t>(entry.track)];
    out[7] = rest.translation;
    out[8] = rest.scale;
    return out;
}

std::vector<glm::vec4> packedEntries(const AnimationSet& set)
{
    std::vector<glm::vec4> texels;
    for (const PaletteEntry& entry : set.palette())
    {
        const PackedEntry one = packed(entry, set.restPose());
        texels.insert(texels.end(), one.begin(), one.end());
    }
    return texels;
}

void widen(PackedKeyframes::Track& all, const PackedKeyframes::Track& one)
{
    all.translation = std::max(all.translation, one.translation);
    all.scale = std::max(all.scale, one.scale);
    all.hasExactKeys = all.hasExactKeys || one.hasExactKeys;
    all.hasCompactKeys = all.hasCompactKeys || one.hasCompactKeys;
}

} // namespace

AnimationBuffers::AnimationBuffers(osg::GLExtensions& gl, const AnimationSet& set, const PackedKeyframes& keyframes)
    : _gl(&gl), _restTexel(keyframes.restTexel()), _levels(set.levelCount()), _isModest(hasModestPalette(set)),
      _keyframes(gl, GL_RGBA32UI_EXT), _entries(gl, GL_RGBA32F_ARB), _masks(gl, GL_RGBA32F_ARB)
{
    _keyframes.upload(keyframes.texels().data(), keyframes.byteSize());
    for (const PackedKeyframes::Track& track : keyframes.tracks())
        widen(_anyTrack, track);
    for (std::size_t level = 0; level < _levels.size(); ++level)
        for (std::size_t entry = set.levels()[level]; entry < set.levels()[level + 1]; ++entry)
            if (const int track = set.palette()[entry].track; track >= 0)
                widen(_levels[std::min<std::size_t>(level, 1)], keyframes.tracks()[static_cast<std::size_t>(track)]);
    for (std::size_t level = 2; level < _levels.size(); ++level)
        _levels[level] = _levels[1];

    const std::vector<glm::vec4> entries = packedEntries(set);
    _entries.upload(entries.data(), entries.size() * sizeof(glm::vec4));
}

const ConstraintBuffers& AnimationBuffers::constraints(const AnimationSet& set, std::uint64_t active)
{
    constexpr std::size_t max = 64; // applications switch constraints on and off in any combination
    if (_constraints.size() >= max && _constraints.count(active) == 0)
    {
        for (auto& [of, buffers] : _constraints)
            buffers->release();
        _constraints.clear();
    }
    std::unique_ptr<ConstraintBuffers>& known = _constraints[active];
    if (!known) known = std::make_unique<ConstraintBuffers>(*_gl, set, active, packedEntries(set));
    return *known;
}

std::size_t AnimationBuffers::texelsPerMask(const AnimationSet& set)
{
    return (set.trackCount() + POSE_WEIGHTS_PER_MASK_TEXEL - 1) / POSE_WEIGHTS_PER_MASK_TEXEL;
}

void AnimationBuffers::updateMasks(const AnimationSet& set, const std::vector<std::shared_ptr<const SetMask>>& masks)
{
    const std::size_t stride = texelsPerMask(set) * POSE_WEIGHTS_PER_MASK_TEXEL;
    bool isChanged = masks.size() > _uploadedMasks.size();
    if (isChanged) _uploadedMasks.resize(masks.size());
    _maskWeights.resize(_uploadedMasks.size() * stride, 1.0f);
    for (std::size_t number = 1; number < masks.size(); ++number)
    {
        if (!masks[number] || _uploadedMasks[number].lock() == masks[number]) continue;
        _uploadedMasks[number] = masks[number];
        std::copy(masks[number]->weights.begin(), masks[number]->weights.end(),
                  _maskWeights.begin() + static_cast<std::ptrdiff_t>(number * stride));
        isChanged = true;
    }
    if (isChanged) _masks.upload(_maskWeights.data(), _maskWeights.size() * sizeof(float));
}

std::size_t AnimationBuffers::byteSize(const AnimationSet& set, const PackedKeyframes& keyframes)
{
    return keyframes.byteSize() + set.paletteSize() * sizeof(PackedEntry);
}

void AnimationBuffers::release()
{
    _keyframes.release();
    _entries.release();
    _masks.release();
    for (auto& [active, buffers] : _constraints)
        buffers->release();
}

} // namespace osgGpuAnimation
