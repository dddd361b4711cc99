// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/WeightRange.h>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

/// Weight number `weight` of a weight block, as the twelve numbers lie in a joint transform.
float weightIn(const JointTransform& block, std::size_t weight)
{
    const int component = static_cast<int>(weight % 4);
    if (weight < 4) return block.translation[component];
    return weight < 8 ? block.rotation[component] : block.scale[component];
}

void include(WeightRange& range, float value)
{
    range.min = std::min(range.min, value);
    range.max = std::max(range.max, value);
}

void includeClip(WeightRange& range, const Clip& clip, std::size_t track, std::size_t place)
{
    const bool isSpline = clip.form() == Clip::Form::Spline;
    for (std::size_t keyframe = 0; keyframe < clip.keyframeCount(); ++keyframe)
    {
        const JointTransform* transform = clip.at(keyframe, track);
        const float value = weightIn(transform[0], place);
        include(range, value);
        if (!isSpline) continue;
        include(range, value - weightIn(transform[1], place) / 3.0f);
        include(range, value + weightIn(transform[2], place) / 3.0f);
    }
}

} // namespace

std::vector<WeightRange> weightRanges(const AnimationSet& set, std::size_t morph)
{
    std::vector<WeightRange> ranges;
    const std::vector<float>& defaults = set.morphs()[morph].defaults;
    for (std::size_t weight = 0; weight < defaults.size(); ++weight)
    {
        const std::size_t track = set.firstTrackOfMorph(morph) + weight / MorphWeights::weightsPerBlock;
        WeightRange range{defaults[weight], defaults[weight]};
        for (const Clip& clip : set.clips())
            includeClip(range, clip, track, weight % MorphWeights::weightsPerBlock);
        ranges.push_back(range);
    }
    return ranges;
}

} // namespace osgGpuAnimation
