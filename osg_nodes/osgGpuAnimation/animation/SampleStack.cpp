// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/SampleStack.h>

#include <layout.glsl>

#include <algorithm>

namespace osgGpuAnimation
{

bool SampleStack::comesBefore(const Placed& a, const Placed& b)
{
    if (a.standing != b.standing) return a.standing < b.standing;
    if (a.sample.weight != b.sample.weight) return a.sample.weight > b.sample.weight;
    if (a.sample.keyframe != b.sample.keyframe) return a.sample.keyframe < b.sample.keyframe;
    return a.sample.alpha < b.sample.alpha;
}

void SampleStack::add(const BlendSample& sample, int standing)
{
    if (!(sample.weight > 0.0f)) return;
    const Placed placed{sample, standing};
    std::size_t place = _placedCount++;
    for (; place > 0 && comesBefore(placed, _placed[place - 1]); --place)
        _placed[place] = _placed[place - 1];
    _placed[place] = placed;
    if (_placedCount + 2 * _differenceCount > PoseInstruction::maxSamples) removeLightest();
}

void SampleStack::addDifference(const BlendSample& reference, const BlendSample& sample)
{
    if (!(sample.weight > 0.0f) || _differenceCount == maxDifferences) return;
    _differences[_differenceCount++] = {reference, sample};
    while (_placedCount + 2 * _differenceCount > PoseInstruction::maxSamples)
        removeLightest();
}

void SampleStack::removeLightest()
{
    const auto end = _placed.begin() + static_cast<std::ptrdiff_t>(_placedCount);
    const auto lightest = std::min_element(
        _placed.begin(), end, [](const Placed& a, const Placed& b) { return a.sample.weight < b.sample.weight; });
    std::move(lightest + 1, end, lightest);
    --_placedCount;
}

void SampleStack::write(PoseInstruction& out) const
{
    out.sampleCount = 0;
    for (std::size_t i = 0; i < _placedCount; ++i)
    {
        BlendSample& sample = out.samples[out.sampleCount++] = _placed[i].sample;
        if (i > 0 && _placed[i].standing != _placed[i - 1].standing) sample.control |= POSE_SAMPLE_ABOVE;
    }
    for (std::size_t i = 0; i < _differenceCount; ++i)
    {
        BlendSample& reference = out.samples[out.sampleCount++] = _differences[i].reference;
        BlendSample& sample = out.samples[out.sampleCount++] = _differences[i].sample;
        reference.weight = sample.weight;
        reference.control |= POSE_SAMPLE_REFERENCE;
        sample.control |= POSE_SAMPLE_ADDITIVE;
    }
    if (out.sampleCount == 0) out.samples[out.sampleCount++] = BlendSample();
}

} // namespace osgGpuAnimation
