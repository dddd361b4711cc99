// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/PoseBatch.h>

namespace osgGpuAnimation
{

std::size_t PoseBatch::add(const PoseInstruction& instruction)
{
    if (instruction.sampleCount > _sampleStride) widen(instruction.sampleCount);
    for (std::size_t i = 0; i < _sampleStride; ++i)
        _samples.push_back(i < instruction.sampleCount ? instruction.samples[i] : BlendSample{0, 0.0f, 0.0f, 0});
    if (!_rootMatrices.empty()) _rootMatrices.emplace_back();
    return _size++;
}

std::size_t PoseBatch::add(const PoseInstruction& instruction, const AffineMatrix& rootMatrix)
{
    const std::size_t instance = add(instruction);
    _rootMatrices.resize(_size);
    _rootMatrices[instance] = rootMatrix;
    return instance;
}

void PoseBatch::widen(std::size_t sampleStride)
{
    std::vector<BlendSample> widened(_size * sampleStride, BlendSample{0, 0.0f, 0.0f, 0});
    for (std::size_t instance = 0; instance < _size; ++instance)
        for (std::size_t i = 0; i < _sampleStride; ++i)
            widened[instance * sampleStride + i] = _samples[instance * _sampleStride + i];
    _samples = std::move(widened);
    _sampleStride = sampleStride;
}

void PoseBatch::clear()
{
    _size = 0;
    _sampleStride = 1;
    _samples.clear();
    _rootMatrices.clear();
}

} // namespace osgGpuAnimation
