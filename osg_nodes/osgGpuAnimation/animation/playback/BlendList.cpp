// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/playback/BlendList.h>

#include <osgGpuAnimation/animation/JointPose.h>

#include <layout.glsl>

#include <algorithm>
#include <cassert>
#include <tuple>

namespace osgGpuAnimation
{

bool BlendList::comesBefore(const Item& a, const Item& b)
{
    if (a.isDifference != b.isDifference) return b.isDifference;
    if (a.blendPriority != b.blendPriority) return a.blendPriority < b.blendPriority;
    if (a.sample.weight != b.sample.weight) return a.sample.weight > b.sample.weight;
    const auto rest = [](const Item& item)
    {
        return std::tie(item.sample.keyframe, item.sample.alpha, item.sample.control, item.reference.keyframe,
                        item.reference.alpha);
    };
    return rest(a) < rest(b);
}

void BlendList::add(const BlendSample& sample, int blendPriority)
{
    insert({sample, BlendSample(), blendPriority, false});
}

void BlendList::addDifference(const BlendSample& reference, const BlendSample& sample)
{
    insert({sample, reference, 0, true});
}

std::uint32_t BlendList::addPose(const std::shared_ptr<JointPose>& pose)
{
    assert(_poseCount < maxLayers && "one pose a layer");
    _poses[_poseCount] = &pose;
    return static_cast<std::uint32_t>(_poseCount++);
}

void BlendList::insert(const Item& item)
{
    if (!(item.sample.weight > 0.0f)) return;
    assert(_count < maxItems && "at most all active clips of all layers");
    if (_count == maxItems) return;
    std::size_t place = _count++;
    for (; place > 0 && comesBefore(item, _places[place - 1].item); --place)
        _places[place].item = _places[place - 1].item;
    _places[place].item = item;
    _sampleCount += item.isDifference ? 2 : 1;
}

/// True for the first, and so the heaviest, sample of a blend priority.
bool BlendList::isAbove(std::size_t index) const
{
    const Item& item = _places[index].item;
    return !item.isDifference && (index == 0 || _places[index - 1].item.blendPriority != item.blendPriority);
}

void BlendList::removeLightest()
{
    // A sample that may be dropped exists: there are at most half as many blend priorities as samples in an
    // instruction.
    std::size_t lightest = _count;
    for (std::size_t i = 0; i < _count; ++i)
        if (!isAbove(i) &&
            (lightest == _count || _places[i].item.sample.weight <= _places[lightest].item.sample.weight))
            lightest = i;
    assert(lightest < _count && "some blend priority has two samples, or there are differences");
    if (lightest == _count) lightest = _count - 1;
    const Item removed = _places[lightest].item;
    std::move(_places.begin() + lightest + 1, _places.begin() + _count, _places.begin() + lightest);
    --_count;
    _sampleCount -= removed.isDifference ? 2 : 1;
    if (removed.isDifference) return;
    // Restores the sum of the blend priority up to 1; PoseInstruction scales larger sums to 1.
    float left = 0.0f;
    for (std::size_t i = 0; i < _count; ++i)
        if (!_places[i].item.isDifference && _places[i].item.blendPriority == removed.blendPriority)
            left += _places[i].item.sample.weight;
    const float whole = std::min(left + removed.sample.weight, 1.0f);
    if (!(left > 0.0f) || left >= whole) return;
    for (std::size_t i = 0; i < _count; ++i)
        if (!_places[i].item.isDifference && _places[i].item.blendPriority == removed.blendPriority)
            _places[i].item.sample.weight *= whole / left;
}

void BlendList::write(PoseInstruction& out)
{
    while (_sampleCount > PoseInstruction::maxSamples)
        removeLightest();
    out.sampleCount = 0;
    out.poses.resize(_poseCount);
    for (std::size_t pose = 0; pose < _poseCount; ++pose)
        if (out.poses[pose] != *_poses[pose]) out.poses[pose] = *_poses[pose];
    for (std::size_t i = 0; i < _count; ++i)
    {
        const Item& item = _places[i].item;
        if (item.isDifference)
        {
            BlendSample& reference = out.samples[out.sampleCount++] = item.reference;
            reference.weight = item.sample.weight;
            reference.control |= POSE_SAMPLE_REFERENCE;
        }
        BlendSample& sample = out.samples[out.sampleCount++] = item.sample;
        if (item.isDifference)
            sample.control |= POSE_SAMPLE_ADDITIVE;
        else if (i > 0 && isAbove(i))
            sample.control |= POSE_SAMPLE_ABOVE;
    }
    if (out.sampleCount == 0) out.samples[out.sampleCount++] = BlendSample();
}

RootMotion rootMotionOf(const Clip& clip, const PlaybackStep& step, LoopMode loopMode)
{
    if (step.distance == 0.0) return {glm::dvec3(0.0), 0.0, clip.rootMotion()->up};
    const RootMotion before = clip.rootMotionAt(step.from).inverse();
    if (loopMode != LoopMode::Loop || step.crossings == 0.0) return before * clip.rootMotionAt(step.to);
    return before * clip.rootMotionAt(clip.duration()).power(step.crossings) * clip.rootMotionAt(step.to);
}

void RootMotionBlend::add(const RootMotion& motion, double weight, int blendPriority)
{
    const auto end = _blendPriorities.begin() + _count;
    const auto here = std::find_if(_blendPriorities.begin(), end,
                                   [&](const BlendPriority& one) { return one.number >= blendPriority; });
    if (here == end || here->number != blendPriority)
    {
        std::move_backward(here, end, end + 1);
        *here = {blendPriority, 0.0, {}};
        ++_count;
    }
    here->weight += weight;
    here->sum.translation += motion.translation * weight;
    here->sum.yaw += motion.yaw * weight;
    here->sum.up = motion.up;
}

RootMotion RootMotionBlend::result() const
{
    RootMotion total;
    for (std::size_t i = 0; i < _count; ++i)
    {
        const BlendPriority& blendPriority = _blendPriorities[i];
        const double left = 1.0 - std::min(blendPriority.weight, 1.0);
        const double share = 1.0 / std::max(blendPriority.weight, 1.0);
        total.translation = total.translation * left + blendPriority.sum.translation * share;
        total.yaw = total.yaw * left + blendPriority.sum.yaw * share;
        total.up = blendPriority.sum.up;
    }
    return total;
}

} // namespace osgGpuAnimation
