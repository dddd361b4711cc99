// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointPose.h>

#include <osg/GL>

#include <cassert>
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

/// The poses of all instances of one set in one frame: a snapshot that does not depend on the controllers. The cull
/// side fills it, the draw side reads it.
///
/// Every instance costs as many blend samples as the instance with the most samples. Many instances of another blend
/// cost therefore belong in a batch of their own, see accepts().
class PoseBatch
{
public:
    /// Starts without instances. set: null counts as an empty one.
    explicit PoseBatch(std::shared_ptr<const AnimationSet> set) : _set(std::move(set)) {}

    /// The set of all instances; an empty one if the batch has none.
    const AnimationSet& set() const { return _set ? *_set : *AnimationSet::orEmpty(nullptr); }
    /// The set of all instances; null if the batch has none.
    const std::shared_ptr<const AnimationSet>& sharedSet() const { return _set; }

    /// Adds an instance and returns its index: 0, 1, 2 … Clamps weights and alphas to [0, 1]; a NaN counts as 0.
    std::size_t add(const PoseInstruction& instruction);
    /// Sets one root matrix for all instances, which then have none of their own. Call it before the first add().
    void setRootMatrix(const AffineMatrix& rootMatrix);
    /// True if the batch has this root matrix for all instances; without one it has the identity.
    bool hasRootMatrix(const AffineMatrix& rootMatrix) const;
    /// Adds an instance whose root joints are multiplied by a root matrix. Other instances have the identity.
    std::size_t add(const PoseInstruction& instruction, const AffineMatrix& rootMatrix);
    /// Does the same for a pose of one sample.
    std::size_t addSample(const BlendSample& sample, const AffineMatrix& rootMatrix);
    /// Adds a pose of BlendCost::Plain, with an alpha in [0, 1], to a batch that has only such poses: no root matrices,
    /// tints or targets.
    void addPlain(const BlendSample& sample)
    {
        assert(_samples.size() == _size && !_needs.mixing && _rootMatrices.empty() && _tints.empty() &&
               _targets.empty() && _posed.empty() && "the batch has only plain poses");
        _samples.push_back(sample);
        ++_size;
    }

    /// The cost of mixing a pose.
    enum class BlendCost
    {
        Plain, ///< one sample of full weight without a mask: no mixing
        Few,   ///< at most four samples: one or two crossfades
        Many,  ///< more than four samples
        Posed, ///< some sample shows a JointPose, however many there are
    };
    /// Number of BlendCost values.
    static constexpr std::size_t blendCostCount = 4;
    /// The cost of one instruction.
    static BlendCost blendCostOf(const PoseInstruction& instruction);
    /// Below this number of instances a second batch costs more than the extra samples of mixed blend costs.
    static constexpr std::size_t minBatchSize = 128;
    /// True if adding the instance would not raise the cost of the batch too far: it has the batch's blend cost, or the
    /// batch has fewer than minBatchSize instances. Instances with and without targets of constraints never share a
    /// batch, so that those without cost nothing more.
    bool accepts(const PoseInstruction& instruction) const;

    /// Sets the colour that multiplies the instance's colour. rgba: 8 bits per channel, red in the lowest bits.
    void setTint(std::size_t instance, std::uint32_t rgba);
    /// Removes all instances and keeps the storage.
    void clear();
    /// Clears the batch and gives it another set, which may be null until the next reset().
    void reset(std::shared_ptr<const AnimationSet> set);

    /// The tint that changes nothing.
    static constexpr std::uint32_t white = 0xFFFFFFFFu;

    /// The features of the mix stage that at least one sample needs.
    struct Needs
    {
        bool mixing = false;               ///< several samples, or one of less than full weight
        bool layers = false;               ///< samples of several blend priorities
        bool masks = false;                ///< samples with masks
        bool additive = false;             ///< additive samples
        bool posed = false;                ///< samples of poses
        std::uint64_t constraints = 0;     ///< bit c: some instance has a target for constraint c of the set
        std::uint64_t directedTargets = 0; ///< bit c: one of these has a pole, a twist or a rotation
        std::uint64_t partialTargets = 0;  ///< bit c: one of these has a weight below 1
    };
    /// The needs of all instances together.
    const Needs& needs() const { return _needs; }

    /// Number of instances.
    std::size_t size() const { return _size; }
    /// Blend samples per instance in samples(): the largest number of any instance.
    std::size_t sampleStride() const { return _sampleStride; }
    /// size() * sampleStride() samples; unused samples have weight 0.
    const std::vector<BlendSample>& samples() const { return _samples; }
    /// size() matrices; a single one: for all instances; empty: the identity for all.
    const std::vector<AffineMatrix>& rootMatrices() const { return _rootMatrices; }
    /// One target per instance and constraint of the set, instance by instance, in the space of the palette; empty: no
    /// instance has one.
    const std::vector<ConstraintTarget>& targets() const { return _targets; }
    /// size() colours; empty if all are white.
    const std::vector<std::uint32_t>& tints() const { return _tints; }
    /// The masks of the samples by number; null: not used here. The batch holds them until it is cleared.
    const std::vector<std::shared_ptr<const SetMask>>& masks() const { return _masks; }
    /// The posed keyframes: the samples of instance i name those from firstPosed(i) on. The batch shares them, so they
    /// do not change.
    const std::vector<std::shared_ptr<const PosedKeyframe>>& posed() const { return _posed; }
    /// instance: at most size(), which gives posed().size().
    std::size_t firstPosed(std::size_t instance) const
    {
        return instance < _firstPosed.size() ? _firstPosed[instance] : _posed.size();
    }
    std::size_t maxPosed() const { return _maxPosed; } ///< the largest number of posed keyframes of any instance
    /// True if the instruction has the poses of the instance, with the same content.
    bool hasPoses(std::size_t instance, const PoseInstruction& instruction) const;
    /// True if both have the same set and the same instances, byte by byte.
    bool isSame(const PoseBatch& other) const;

private:
    bool holdMask(std::uint32_t number);
    std::size_t append(const BlendSample* samples, std::size_t count, const PoseInstruction* instruction);
    bool usePose(const PoseInstruction& instruction, BlendSample& sample);
    void addTargets(const std::vector<ConstraintTarget>& targets, const AffineMatrix& rootMatrix);
    std::size_t addInstance(const PoseInstruction& instruction, const AffineMatrix& rootMatrix);

    std::shared_ptr<const AnimationSet> _set;
    std::size_t _size = 0;
    std::size_t _sampleStride = 1;
    Needs _needs;
    std::vector<BlendSample> _samples;
    std::vector<AffineMatrix> _rootMatrices;
    std::vector<ConstraintTarget> _targets;
    bool _isRootCommon = false; ///< true: _rootMatrices has one matrix for all instances
    std::vector<std::uint32_t> _tints;
    std::vector<std::shared_ptr<const SetMask>> _masks;
    std::vector<std::shared_ptr<const PosedKeyframe>> _posed;
    std::vector<std::uint32_t> _firstPosed; ///< by instance; empty: no instance has posed keyframes
    std::size_t _maxPosed = 0;
};

} // namespace osgGpuAnimation
