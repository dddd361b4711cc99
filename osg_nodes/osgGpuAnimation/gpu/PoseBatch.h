// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// What all instances of one set are to show in one frame: a snapshot, independent of the controllers it came from.
/// Filled on the cull side, read on the draw side.
class PoseBatch
{
public:
    explicit PoseBatch(std::shared_ptr<const AnimationSet> set) : _set(std::move(set)) {}

    const AnimationSet& set() const { return *_set; }
    const std::shared_ptr<const AnimationSet>& sharedSet() const { return _set; }

    /// Takes an instance up and returns its number: 0, 1, 2 …
    std::size_t add(const PoseInstruction& instruction);
    /// The same with a root matrix, which the instance's root joints are multiplied by. Instances without one get the
    /// identity as soon as any has one.
    std::size_t add(const PoseInstruction& instruction, const AffineMatrix& rootMatrix);
    void clear();

    std::size_t size() const { return _size; }
    /// Blend samples an instance takes in samples(): the largest number any instance has.
    std::size_t sampleStride() const { return _sampleStride; }
    /// size() * sampleStride(); what an instance does not need has weight 0.
    const std::vector<BlendSample>& samples() const { return _samples; }
    /// size() matrices, or none where no instance has one.
    const std::vector<AffineMatrix>& rootMatrices() const { return _rootMatrices; }

private:
    void widen(std::size_t sampleStride);

    std::shared_ptr<const AnimationSet> _set;
    std::size_t _size = 0;
    std::size_t _sampleStride = 1;
    std::vector<BlendSample> _samples;
    std::vector<AffineMatrix> _rootMatrices;
};

} // namespace osgGpuAnimation
