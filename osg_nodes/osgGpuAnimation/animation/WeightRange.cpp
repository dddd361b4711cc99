// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/WeightRange.h>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

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
        const float value = transform[0].number(place);
        include(range, value);
        if (!isSpline) continue;
        include(range, value - transform[1].number(place) / 3.0f);
        include(range, value + transform[2].number(place) / 3.0f);
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
