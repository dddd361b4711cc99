// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/ClipMarker.h>
#include <osgGpuAnimation/animation/JointTransform.h>
#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

struct ClipParts;
struct CompactTracks;
struct RootMotionCurve;

/// A clip: keyframes in time order; each keyframe is a snapshot of **all tracks** (all joints, then all weight blocks).
///
/// Between two keyframes a track is mixed: Linear clips mix translations, scales and weights componentwise and slerp
/// rotations the short way; Spline clips hold for each track a value and two tangents and take the Hermite form
/// (glTF 2.0, appendix C.5), tangents being scaled by the length of their interval already. Two keyframes at the same
/// time are a jump (STEP): at that time the later one holds.
///
/// In a Spline clip a joint track whose rotation is to be slerped has translation.w == 1 in its value, else 0, and
/// rotation values are not unit (the spline's own numbers; made unit after mixing).
///
/// Made by ClipBuilder; immutable. Copies share the keyframes.
class Clip
{
public:
    enum class Form
    {
        Linear, ///< one JointTransform a track a keyframe: the value
        Spline, ///< three a track a keyframe: value, in-tangent, out-tangent
    };

    /// Where a time falls: mix keyframe and keyframe + 1 by alpha. alpha is 0 on the last keyframe.
    struct Span
    {
        std::size_t keyframe = 0;
        float alpha = 0.0f; ///< [0, 1)
    };

    /// A clip of these keyframes, as another said them of itself: to keep clips elsewhere than in a glTF file. For
    /// what has channels there is ClipBuilder.
    /// Errors: no keyframes; times that are not finite, negative, descending or more than twice the same; numbers that
    /// are not finite; a wrong number of them; in a Linear clip a joint's rotation of length 0; a marker's time or a
    /// root motion that is none of such a clip.
    static Result<Clip> create(ClipParts parts);

    const std::string& name() const { return _name; }
    Form form() const { return _form; }
    double duration() const { return _times.empty() ? 0.0 : _times.back(); } ///< seconds; the last keyframe's time
    std::size_t trackCount() const { return _trackCount; }
    std::size_t keyframeCount() const { return _times.size(); }
    const std::vector<float>& times() const { return _times; } ///< keyframeCount() seconds, ascending, twice at a jump

    std::size_t transformsPerTrack() const { return transformsPerTrack(_form); } ///< in a keyframe
    static constexpr std::size_t transformsPerTrack(Form form) { return form == Form::Spline ? 3 : 1; }
    /// JointTransforms from one keyframe to the next in data().
    std::size_t keyframeStride() const { return _trackCount * transformsPerTrack(); }
    /// keyframeCount() * keyframeStride() transforms: by keyframe, then track, then (Spline) value, in, out.
    const std::vector<JointTransform>& data() const { return *_data; }
    /// The track's transformsPerTrack() transforms in a keyframe.
    const JointTransform* at(std::size_t keyframe, std::size_t track) const
    {
        return data().data() + keyframe * keyframeStride() + track * transformsPerTrack();
    }

    /// By time; those of one time in the order in which they were added.
    const std::vector<ClipMarker>& markers() const { return _markers; }
    /// The same clip with further markers. What lies beyond the duration counts as at the duration.
    /// Error: a time that is negative or not finite.
    Result<Clip> withMarkers(std::vector<ClipMarker> markers) const;

    /// The motion that was taken out of this clip, see withRootMotion(); null where none was.
    const RootMotionCurve* rootMotion() const { return _rootMotion.get(); }

    /// How a compact clip goes to the GPU, see compactClips(); data() then holds what that decodes to. Null: exactly.
    const CompactTracks* compactTracks() const { return _compactTracks.get(); }

    /// By binary search; times before the first keyframe give the first, after the last the last.
    Span locate(double time) const;

private:
    friend class ClipBuilder;
    friend class ClipCompactor;
    friend class RootMotionExtractor;
    Clip() = default;

    std::string _name;
    Form _form = Form::Linear;
    std::size_t _trackCount = 0;
    std::vector<float> _times;
    std::shared_ptr<std::vector<JointTransform>> _data = std::make_shared<std::vector<JointTransform>>();
    std::vector<ClipMarker> _markers;
    std::shared_ptr<const RootMotionCurve> _rootMotion;
    std::shared_ptr<const CompactTracks> _compactTracks;
};

} // namespace osgGpuAnimation
