// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/passes/CpuEvaluation.h>

#include <osgGpuAnimation/animation/Pose.h>

namespace osgGpuAnimation
{

void evaluateOnCpu(const PoseBatch& batch, PosePalette::Chunk& chunk, std::vector<AffineMatrix>& memory)
{
    const AnimationSet& set = batch.set();
    const std::vector<AffineMatrix>& roots = chunk.uploadedRootMatrices;
    const std::size_t targetStride = chunk.uploadedTargets.size() / chunk.size;
    memory.resize(set.paletteSize() * chunk.width);
    std::vector<AffineMatrix> palette;
    for (std::size_t instance = 0; instance < chunk.size; ++instance)
    {
        Pose::BatchedPose pose;
        pose.samples = &chunk.uploadedSamples[instance * chunk.sampleStride];
        pose.sampleCount = chunk.sampleStride;
        pose.posed = batch.posed().data();
        if (targetStride > 0) pose.targets = &chunk.uploadedTargets[instance * targetStride];
        const AffineMatrix root = roots.empty() ? AffineMatrix() : roots[roots.size() == 1 ? 0 : instance];
        Pose::evaluate(set, pose, root, palette);
        for (std::size_t entry = 0; entry < palette.size(); ++entry)
            memory[entry * chunk.width + instance] = palette[entry];
    }
    chunk.palette.upload(memory.data(), memory.size() * sizeof(AffineMatrix));
}

} // namespace osgGpuAnimation
