// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Box.h>
#include <osgGpuAnimation/math/detail/Builtins.h>

#include <algorithm>
#include <array>
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

    /// Of the whole clip, in model units.
    float length() const { return _samples.empty() ? 0.0f : _samples.back().piece.travel; }
    /// The travel at a time in seconds, in [0, length()].
    float at(float time) const
    {
        if (_parts.empty() || !(time > 0.0f)) return 0.0f;
        const Part& part = partAt(time);
        if (part.isSearched) return search(time);
        // Without a branch, which no processor could predict.
        const Piece& piece = part.pieces[static_cast<std::size_t>(time >= part.pieces[1].time)];
        return piece.at(time);
    }
    /// Starts to load what at() reads. time: in [0, duration).
    void prefetch(float time) const
    {
        if (!_parts.empty()) osgGpuAnimation::prefetch(&partAt(time));
    }
    /// The pose with that travel; in a jump of the clip the nearer one of the poses before and after.
    BlendSample sampleAt(float travel) const;

private:
    /// Times at which the fastest vertex has one speed.
    struct Piece
    {
        float time; ///< of its start
        float travel;
        float speed; ///< travel per second; 0: a jump or the end

        float at(float now) const { return travel + std::max(now - time, 0.0f) * speed; }
    };
    /// A pose of the clip.
    struct Sample
    {
        float alpha;            ///< to the next keyframe
        std::uint32_t keyframe; ///< of the set
        Piece piece;            ///< from here to the next sample
    };
    /// Equal parts of the duration: a look-up reads one place of memory.
    struct Part
    {
        std::array<Piece, 2> pieces; ///< of its start, and the next one
        bool isSearched;             ///< there are more
    };

    /// time: at least 0.
    const Part& partAt(float time) const
    {
        return _parts[static_cast<std::size_t>(static_cast<std::int32_t>(std::min(time * _partsPerSecond, _lastPart)))];
    }
    void divide(double duration);
    float search(float time) const;

    std::vector<Sample> _samples; ///< ascending, the same time twice at a jump
    std::vector<Part> _parts;     ///< as many as samples
    float _partsPerSecond = 0.0f;
    float _lastPart = 0.0f;
    std::uint32_t _control = 0; ///< see BlendSample
};

} // namespace osgGpuAnimation
