// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/math/Box.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// The distance that the fastest vertex of each moment covers since the start of a clip: no vertex moves farther
/// between two times of the clip than the difference of their travels. Phases of equal travel therefore have equal
/// errors, at any speed of the clip. A jump counts its distance and the size of the character, so that a phase rarely
/// holds both of its sides.
class ClipTravel
{
public:
    /// The travel of a clip without motion: 0.
    ClipTravel() = default;
    /// entryBoxes: the box of the vertices of each palette entry. reaches: see MixBounds::Boxes. clip: of the set.
    ClipTravel(const AnimationSet& set, std::size_t clip, const EntryBoxes& entryBoxes,
               const std::vector<float>& reaches);

    float length() const
    {
        return _samples.empty() ? 0.0f : _samples.back().travel;
    } ///< of the whole clip, in model units
    /// The travel at a time in seconds, in [0, length()].
    float at(float time) const
    {
        if (!(length() > 0.0f) || !(time > 0.0f)) return 0.0f;
        const auto part =
            static_cast<std::size_t>(std::min(time * _partsPerSecond, static_cast<float>(_firstOf.size() - 2)));
        const Sample *sample = &_samples[_firstOf[part]], *last = &_samples[_firstOf[part + 1]];
        const auto isBefore = [](float wanted, const Sample& after) { return wanted < after.time; };
        if (last - sample > 1)
            sample = std::upper_bound(sample + 1, last + 1, time, isBefore) - 1;
        else // without a branch, which no processor could predict
            sample += static_cast<int>(last != sample) & static_cast<int>(time >= last->time);
        return sample->travel + std::max(time - sample->time, 0.0f) * sample->speed;
    }
    /// The pose with that travel; in a jump of the clip the nearer one of the poses before and after.
    BlendSample sampleAt(float travel) const;

private:
    /// A pose of the clip.
    struct Sample
    {
        float time;
        float travel;
        std::uint32_t keyframe; ///< of the set
        float alpha;            ///< to the next keyframe
        float speed = 0.0f;     ///< travel per second to the next sample; 0: a jump or the end
    };

    std::vector<Sample> _samples;        ///< ascending, the same time twice at a jump
    std::vector<std::uint32_t> _firstOf; ///< by part of the duration: the last sample at or before its start
    float _partsPerSecond = 0.0f;
    std::uint32_t _control = 0; ///< see BlendSample
};

} // namespace osgGpuAnimation
