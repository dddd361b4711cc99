// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <osg/GL>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// An instance's palette on the GPU: entry e is matrix e * stride + instance of the texture.
struct PalettePlace
{
    GLuint texture = 0;         ///< buffer texture, RGBA32F; 0: the instance has no palette and is not drawn
    int stride = 0;             ///< matrices per entry
    int instance = 0;           ///< in [0, stride)
    GLuint tints = 0;           ///< buffer texture, RGBA8, one colour per instance; 0: all colours are white
    std::size_t chunkBegin = 0; ///< first instance of the batch in this texture
    std::size_t chunkEnd = 0;   ///< one past the last instance of the batch in this texture
};

/// What all instances of one set are to show in one frame: a snapshot, independent of the controllers it came from.
/// Filled on the cull side, read on the draw side.
///
/// Each instance costs as many blend samples as the one that has most, so instances of another load are better put into
/// a batch of their own where there are many: see suits().
class PoseBatch
{
public:
    explicit PoseBatch(std::shared_ptr<const AnimationSet> set) : _set(std::move(set)) {}

    const AnimationSet& set() const { return *_set; }
    const std::shared_ptr<const AnimationSet>& sharedSet() const { return _set; }

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
        Many,
    };
    static constexpr std::size_t blendCostCount = 3;
    static BlendCost loadOf(const PoseInstruction& instruction);
    /// Instances whose mixing costs as much as another batch: with fewer, one of another load may join them.
    static constexpr std::size_t minBatchSize = 128;
    /// Whether the instruction may come in without making many dearer, or being dear itself for the sake of others.
    bool accepts(const PoseInstruction& instruction) const;

    /// What the instance's colour is multiplied by. rgba: 8 bits each, red lowest. Others stay white.
    void setTint(std::size_t instance, std::uint32_t rgba);
    void clear();
    /// Empty again, for instances of another set, or of none until the next reset; the storage is kept.
    void reset(std::shared_ptr<const AnimationSet> set);

    static constexpr std::uint32_t white = 0xFFFFFFFFu;

    /// What the samples ask of the mix stage, taken together.
    struct Needs
    {
        bool mixing = false; ///< several samples, or one of less than full weight
        bool layers = false;
        bool masks = false;
        bool additive = false;
    };
    const Needs& needs() const { return _needs; }

    std::size_t size() const { return _size; }
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
