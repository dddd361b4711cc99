// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationEvent.h>
#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/ClipMixer.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>
#include <osgGpuAnimation/animation/RootMotion.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace osgGpuAnimation
{

/// Sorts the samples of all layers as PoseInstruction requires: blend priorities from the bottom up; within a blend
/// priority the heaviest sample first, and samples of equal weight by keyframe, so that the order of add() does not
/// matter; additive samples last.
///
/// Beyond PoseInstruction::maxSamples, where a difference counts as two samples, the samples with the lowest weights
/// are dropped. The heaviest sample of each blend priority always stays. The other samples of the blend priority take
/// over the dropped weight, so that nothing below them, such as the rest pose, becomes visible.
class BlendList
{
public:
    /// the maximum number of samples and differences that all layers can have: of eight clips and a pose each
    static constexpr std::size_t maxItems = maxLayers * (ClipMixer::maxActiveClips + 1);

    /// Samples of weight 0 are ignored. At most maxItems samples and differences may be added.
    void add(const BlendSample& sample, int blendPriority);
    void addDifference(const BlendSample& reference, const BlendSample& sample);
    /// The keyframe of samples that show the pose (see POSE_SAMPLE_POSED): at most maxLayers poses. pose: must stay
    /// until write().
    std::uint32_t addPose(const std::shared_ptr<JointPose>& pose);
    /// Writes the instruction; the rest pose if nothing was added. Call it once.
    void write(PoseInstruction& out);

private:
    struct Item
    {
        BlendSample sample, reference; ///< the reference of a difference
        int blendPriority;             ///< of a sample
        bool isDifference;
    };
    /// Deliberately uninitialized: zeroing dominated the cost.
    union Place
    {
        Place() {}
        Item item;
    };

    static bool comesBefore(const Item& a, const Item& b);
    void insert(const Item& item);
    bool isAbove(std::size_t index) const;
    void removeLightest();

    std::array<Place, maxItems> _places;
    std::size_t _count = 0;
    std::size_t _sampleCount = 0; ///< samples of the items in an instruction
    std::array<const std::shared_ptr<JointPose>*, maxLayers> _poses;
    std::size_t _poseCount = 0;
};

/// The root motion of a step through a clip, however often it loops. The clip must have a rootMotion().
RootMotion rootMotionOf(const Clip& clip, const PlaybackStep& step, LoopMode loopMode);

/// Blends the root motions of all clips that play in one step. Blend priorities and weights work as in PoseInstruction;
/// the rest pose does not move.
class RootMotionBlend
{
public:
    void add(const RootMotion& motion, double weight, int blendPriority);
    RootMotion result() const;

private:
    struct BlendPriority
    {
        int number = 0;
        double weight = 0.0;
        RootMotion sum;
    };

    std::array<BlendPriority, maxLayers> _blendPriorities; ///< from the bottom up
    std::size_t _count = 0;
};

} // namespace osgGpuAnimation
