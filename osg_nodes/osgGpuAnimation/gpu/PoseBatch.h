// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// What all instances of one set are to show in one frame: a snapshot, independent of the controllers it came from.
/// Filled on the cull side, read on the draw side.
///
/// Each instance costs as many blend samples as the one that has most, so instances of another load are better put into
/// a batch of their own where there are many: see suits().
class PoseBatch
{
public:
    /// An empty batch. set: the set of all its instances.
    explicit PoseBatch(std::shared_ptr<const AnimationSet> set) : _set(std::move(set)) {}

    const AnimationSet& set() const { return *_set; }                             ///< The set must not be null.
    const std::shared_ptr<const AnimationSet>& sharedSet() const { return _set; } ///< null after reset(nullptr)

    /// Takes an instance up and returns its number: 0, 1, 2 … Weights and alphas that are no numbers or outside [0, 1]
    /// count as the nearest.
    std::size_t add(const PoseInstruction& instruction);
    /// The same with a root matrix, which the instance's root joints are multiplied by. Instances without one get the
    /// identity as soon as any has one.
    std::size_t add(const PoseInstruction& instruction, const AffineMatrix& rootMatrix);
    /// The same for an instance that shows one sample.
    std::size_t addSample(const BlendSample& sample, const AffineMatrix& rootMatrix);

    /// What a pose costs to mix.
    enum class BlendCost
    {
        Plain, ///< one sample, as it is: nothing to mix
        Few,   ///< a crossfade or two: up to four samples
        Many,  ///< more than four samples
    };
    static constexpr std::size_t blendCostCount = 3;             ///< number of BlendCost values
    static BlendCost loadOf(const PoseInstruction& instruction); ///< cost of an instruction
    /// Instances whose mixing costs as much as another batch: with fewer, one of another load may join them.
    static constexpr std::size_t minBatchSize = 128;
    /// Whether the instruction may come in without making many dearer, or being dear itself for the sake of others.
    bool accepts(const PoseInstruction& instruction) const;

    /// What the instance's colour is multiplied by. rgba: 8 bits each, red lowest. Others stay white.
    void setTint(std::size_t instance, std::uint32_t rgba);
    void clear(); ///< removes all instances
    /// Empty again, for instances of another set, or of none until the next reset; the storage is kept.
    void reset(std::shared_ptr<const AnimationSet> set);

    static constexpr std::uint32_t white = 0xFFFFFFFFu; ///< the neutral tint

    /// What the samples ask of the mix stage, taken together.
    struct Needs
    {
        bool mixing = false;   ///< several samples, or one of less than full weight
        bool layers = false;   ///< more than one blend priority
        bool masks = false;    ///< samples with a mask
        bool additive = false; ///< additive samples
    };
    const Needs& needs() const { return _needs; } ///< of all instances together

    std::size_t size() const { return _size; } ///< number of instances
    /// Blend samples an instance takes in samples(): the largest number any instance has.
    std::size_t sampleStride() const { return _sampleStride; }
    /// size() * sampleStride(); what an instance does not need has weight 0.
    const std::vector<BlendSample>& samples() const { return _samples; }
    /// size() matrices, or none where no instance has one.
    const std::vector<AffineMatrix>& rootMatrices() const { return _rootMatrices; }
    /// size() colours, or none where all are white.
    const std::vector<std::uint32_t>& tints() const { return _tints; }
    /// Whether both say the same of the same set, instance by instance.
    bool isSame(const PoseBatch& other) const;

private:
    void widen(std::size_t sampleStride);
    void note(const BlendSample& sample);
    BlendCost load() const;

    std::shared_ptr<const AnimationSet> _set;
    std::size_t _size = 0;
    std::size_t _sampleStride = 1;
    Needs _needs;
    std::vector<BlendSample> _samples;
    std::vector<AffineMatrix> _rootMatrices;
    std::vector<std::uint32_t> _tints;
};

} // namespace osgGpuAnimation
