// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/authoring/keyframes/PoseDistance.h>

#include <vector>

namespace osgGpuAnimation
{

class BitAllocator;

/// Creates compact clips of the clips of a set, see compactClips().
class ClipCompactor
{
public:
    /// size, tolerance: in the model's units, above 0. The set must outlive this object.
    ClipCompactor(const AnimationSet& set, const EntryBoxes& entryBoxes, double size, double tolerance);

    /// The compact clip, or the clip itself if the tolerance cannot be met.
    Clip compact(const Clip& clip);
    double error() const { return _error; } ///< of the last result of compact(), in the model's units

private:
    Clip attempt(const Clip& clip, double constantShare, double droppedShare);
    void makePartsConstant(const Clip& clip, std::vector<JointTransform>& data, double most) const;
    std::vector<std::size_t> keptKeyframes(const Clip& clip, const std::vector<JointTransform>& data, double most);
    std::size_t farthest(const Clip& clip, const std::vector<JointTransform>& data, std::size_t from, double most);
    bool chooseBits(const Clip& clip, const std::vector<std::size_t>& kept, BitAllocator& bits);
    template <typename Visit>
    void forPosesBetween(const Clip& clip, std::size_t from, std::size_t to, Visit visit);
    void mix(const JointTransform* a, const JointTransform* b, double alpha, std::vector<JointTransform>& out) const;
    double errorOf(const Clip& clip, const Clip& made, const std::vector<std::size_t>& kept);

    const AnimationSet& _set;
    double _tolerance;
    double _size;
    PoseDistance _distance;
    double _error = 0.0;
    std::vector<JointTransform> _exactPose, _madePose;
};

} // namespace osgGpuAnimation
