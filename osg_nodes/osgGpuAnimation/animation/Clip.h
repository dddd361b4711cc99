// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/RootMotion.h>
#include <osgGpuAnimation/math/JointTransform.h>
#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A named time of a clip, for example when a foot touches the ground.
struct ClipMarker
{
    double time = 0.0; ///< seconds on the clip's time line, in [0, duration]
    std::string name;  ///< not necessarily unique
};

struct ClipParts;
struct CompactTracks;

/// A clip: keyframes in time order. Each keyframe has one transform of **every track**: joints, then weight blocks.
///
/// Between two keyframes a Linear clip mixes translations, scales and weights componentwise and slerps rotations the
/// short way. A Spline clip stores a value and two tangents per track and uses the Hermite form (glTF 2.0, appendix
/// C.5); the tangents are already multiplied by the length of their interval. Two keyframes at the same time are a jump
/// (STEP): at that time the later one is valid.
///
/// In a Spline clip, translation.w of a joint's value says how its rotation is mixed: 1 means slerp, 0 means spline.
/// The rotations of a spline are not unit; they are normalized after the mix.
///
/// ClipBuilder creates clips. A clip is immutable; copies share the keyframes.
class Clip
{
public:
    /// The storage of the keyframes.
    enum class Form
    {
        Linear, ///< one JointTransform per track and keyframe: the value
        Spline, ///< three per track and keyframe: value, in-tangent, out-tangent
    };

    /// The keyframes of a time: a mix of keyframe and keyframe + 1 by alpha. At the last keyframe alpha is 0.
    struct Span
    {
        std::size_t keyframe = 0; ///< below Clip::keyframeCount()
        float alpha = 0.0f;       ///< [0, 1)
    };

    /// Creates a clip from data that another clip exported, for example to restore a stored clip. ClipBuilder creates
    /// clips from channels.
    /// Errors: no keyframes; times that are not finite, negative, descending or the same more than twice; numbers that
    /// are not finite; a wrong number of transforms; in a Linear clip a joint's rotation of length 0; a marker with an
    /// invalid time; compact tracks or a root motion that do not fit the clip.
    static Result<Clip> create(ClipParts parts);

    const std::string& name() const { return _name; }                        ///< not necessarily unique
    Form form() const { return _form; }                                      ///< storage of the keyframes
    double duration() const { return _times.empty() ? 0.0 : _times.back(); } ///< seconds; the last keyframe's time
    std::size_t trackCount() const { return _trackCount; }                   ///< joints, then weight blocks
    std::size_t keyframeCount() const { return _times.size(); }              ///< number of keyframes
    /// keyframeCount() times in seconds, ascending, the same twice at a jump.
    const std::vector<float>& times() const { return _times; }

    std::size_t transformsPerTrack() const { return transformsPerTrack(_form); } ///< in a keyframe
    /// Transforms per track and keyframe: 1 for Linear, 3 for Spline.
    static constexpr std::size_t transformsPerTrack(Form form) { return form == Form::Spline ? 3 : 1; }
    /// JointTransforms per keyframe in data().
    std::size_t keyframeStride() const { return _trackCount * transformsPerTrack(); }
    /// keyframeCount() * keyframeStride() transforms: by keyframe, then by track, then (Spline) value, in- and
    /// out-tangent.
    const std::vector<JointTransform>& data() const { return *_data; }
    /// The transformsPerTrack() transforms of a track in a keyframe.
    const JointTransform* at(std::size_t keyframe, std::size_t track) const
    {
        return data().data() + keyframe * keyframeStride() + track * transformsPerTrack();
    }

    /// The markers by time; markers of the same time keep the order in which they were added.
    const std::vector<ClipMarker>& markers() const { return _markers; }
    /// A copy of the clip with further markers. A marker after the end of the clip moves to the end.
    /// Error: a time that is negative or not finite.
    Result<Clip> withMarkers(std::vector<ClipMarker> markers) const;

    /// A copy of the clip with another name.
    Clip withName(std::string name) const;

    /// The motion that withRootMotion() removed from the clip; null if it removed none.
    const RootMotionCurve* rootMotion() const { return _rootMotion.get(); }
    /// That motion from the first keyframe to a time in seconds. There must be a rootMotion().
    RootMotion rootMotionAt(double time) const;

    /// The keyframes of a compact clip as the GPU stores them, see compactClips(); data() has the decoded values. Null
    /// for an exact clip.
    const CompactTracks* compactTracks() const { return _compactTracks.get(); }

    /// Finds the keyframes of a time by binary search. Times outside the clip give its first or last keyframe.
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

/// The input of Clip::create(): everything that a clip exports.
struct ClipParts
{
    std::string name;                                  ///< not necessarily unique
    Clip::Form form = Clip::Form::Linear;              ///< as Clip::form()
    std::size_t jointCount = 0;                        ///< the first tracks; their transforms belong to joints
    std::size_t trackCount = 0;                        ///< joints, then weight blocks
    std::vector<float> times;                          ///< as Clip::times()
    std::vector<JointTransform> data;                  ///< as Clip::data()
    std::vector<ClipMarker> markers;                   ///< times in [0, duration]
    std::shared_ptr<const RootMotionCurve> rootMotion; ///< null: none
    /// null: exact; else create() writes their decoded values to data
    std::shared_ptr<const CompactTracks> compactTracks;
};

} // namespace osgGpuAnimation
