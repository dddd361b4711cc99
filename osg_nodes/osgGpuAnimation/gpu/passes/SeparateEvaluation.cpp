// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/passes/SeparateEvaluation.h>

#include <algorithm>

namespace osgGpuAnimation
{

bool evaluateSeparately(EvaluationContext& context, FeedbackScope& scope, const PoseBatch& batch,
                        const AnimationBuffers& buffers, PosePalette::Chunk& chunk)
{
    const AnimationSet& set = batch.set();
    const std::size_t trackVertices = set.trackCount() * chunk.width;
    context.mixedTracks.reserve(trackVertices * sizeof(JointTransform));
    context.scratch.reserve(trackVertices * EvaluationContext::matrixBytes);
    const auto run = [&](FeedbackPass& pass, std::size_t count, const BufferTexture& out)
    {
        pass.run(0, count, out.buffer(), 0);
        ++context.draws;
    };

    PoseVariant variant = PoseVariant::of(batch, buffers.isModest());
    variant.setMotion(buffers.anyTrack());
    variant.translationMotion = std::max(variant.translationMotion, PartMotion::Constant);
    variant.scaleMotion = std::max(variant.scaleMotion, PartMotion::Constant);
    using Stage = EvaluationContext::Stage;
    FeedbackPass &mix = context.pass(Stage::Mix, variant), &local = context.pass(Stage::Local),
                 &world = context.pass(Stage::World);
    if (!mix.valid() || !local.valid() || !world.valid()) return false;
    context.useMixInput(scope, mix, set, buffers, chunk);
    run(mix, trackVertices, context.mixedTracks);

    local.use();
    local.setTexture(scope, "mixedTracks", unitPrevious, context.mixedTracks.texture());
    local.setInt("instanceCount", static_cast<int>(chunk.width));
    local.setInt("jointCount", static_cast<int>(set.skeleton().jointCount()));
    run(local, trackVertices, context.scratch);

    world.use();
    world.setInt("instanceCount", static_cast<int>(chunk.width));
    world.setTexture(scope, "entries", unitEntries, buffers.entries().texture());
    world.setTexture(scope, "roots", unitRoots, chunk.roots.texture());
    world.setInt("rootCount", static_cast<int>(chunk.uploadedRootMatrices.size()));
    world.setTexture(scope, "localMatrices", unitPrevious, context.scratch.texture());
    run(world, set.paletteSize() * chunk.width, chunk.palette);
    return true;
}

} // namespace osgGpuAnimation
