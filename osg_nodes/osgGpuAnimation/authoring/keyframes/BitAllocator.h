// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/authoring/keyframes/PoseDistance.h>

#include <array>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// Chooses how many bits each number of a compact clip takes: it begins with few, and each raise() gives one more to
/// the numbers whose rounding moves a point most.
class BitAllocator
{
public:
    /// wanted: trackCount() transforms per keyframe; they are rounded here. The set must outlive this object.
    BitAllocator(const AnimationSet& set, std::vector<JointTransform> wanted);

    /// Begins with the bits with which no number alone moves a point of the first keyframe farther than `most`.
    void begin(const PoseDistance& distance, double max);
    /// Gives numbers that move the point more bits. pose: a mix of rounded keyframes, the last one of distance.to().
    /// False: all of them have the most bits.
    bool raise(const std::vector<JointTransform>& pose, const PoseDistance& distance, const PoseDistance::Worst& worst);

    /// The rounded keyframes.
    const std::vector<JointTransform>& rounded() const { return _rounded; }
    /// The tracks, packed, and the keyframes that they show. False: a record would be too large.
    bool finish(CompactTracks& outTracks, std::vector<JointTransform>& outData);

private:
    static constexpr std::size_t partCount = 3;
    /// A part of a joint that moves: the range of its values.
    struct Moving
    {
        bool isMoving = false;
        glm::vec3 min{0.0f};
        glm::vec3 max{0.0f};
    };
    struct Number
    {
        std::size_t joint = 0;
        std::size_t part = 0;
        int axis = 0;
    };

    template <typename Visit>
    void forNumbers(std::size_t joint, Visit visit) const;
    glm::uvec3 bitsOf(std::size_t joint, std::size_t part) const;
    float maxError(const Number& number) const;
    double effect(const JointTransform& transform, const Number& number, const glm::vec3& point,
                  const std::vector<AffineMatrix>& jointToModel) const;
    void addBit(const Number& number);
    void setBits(std::size_t joint, std::size_t part, const glm::uvec3& bits);
    void round(std::size_t joint);

    const AnimationSet& _set;
    std::vector<JointTransform> _wanted, _rounded;
    std::vector<std::array<Moving, partCount>> _moving; ///< by joint: translation, rotation, scale
    CompactTracks _tracks;
    std::vector<std::pair<double, Number>> _effects; ///< of the last raise()
};

} // namespace osgGpuAnimation
