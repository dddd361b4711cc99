// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/AnimationBuffers.h>
#include <osgGpuAnimation/gpu/buffers/PosePalette.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
#include <osgGpuAnimation/gpu/passes/PoseVariant.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace osgGpuAnimation
{

/// The texture units of the passes. Those from unitCorrections on are for batches with constraints only.
enum PoseUnit : int
{
    unitKeyframes,
    unitSamples,
    unitEntries,
    unitRoots,
    unitPrevious,
    unitMasks,
    unitPosed,
    unitCorrections,
    unitJointsAbove,
    unitTargets,
};
static_assert(unitTargets < FeedbackScope::unitCount, "the scope unbinds all units");

/// What all evaluations in one graphics context share: the passes, which are compiled at first use, and the buffers of
/// intermediate results.
struct EvaluationContext
{
    static constexpr std::size_t matrixBytes = sizeof(AffineMatrix);
    static constexpr std::size_t rotationBytes = BufferTexture::texelBytes;

    /// Units (palette entries, or joints, of all instances) to copy from one buffer to another.
    struct UnitCopy
    {
        std::size_t from, to; ///< the first unit in each
        std::size_t count;
    };

    explicit EvaluationContext(osg::GLExtensions& gl);

    enum class Stage
    {
        Pose,      ///< the fused form
        Constrain, ///< one constraint in the fused form
        Mix,       ///< the first pass of the separate form
        Local,
        World,
    };

    /// variant: of all stages but the last two. shape: of the constraint.
    FeedbackPass& pass(Stage stage, const PoseVariant& variant = {}, const ConstraintShape& shape = {});
    /// Makes a pass with the mix stage current, with its input.
    void useMixInput(FeedbackScope& scope, FeedbackPass& pass, const AnimationSet& set, const AnimationBuffers& buffers,
                     const PosePalette::Chunk& chunk) const;
    void copy(const BufferTexture& from, const BufferTexture& to, std::size_t unitBytes,
              const std::vector<UnitCopy>& copies) const;

    void release(); ///< deletes the GL objects
    void discard(); ///< forgets them

    osg::GLExtensions* gl;
    void(GL_APIENTRY* copyBufferSubData)(GLenum, GLenum, GLintptr, GLintptr, GLsizeiptr) = nullptr;
    FeedbackVertexArrays vertexArrays;
    BufferTexture scratch;     ///< fused: the odd levels, one after the other, then garments; separate: local matrices
    BufferTexture mixedTracks; ///< separate: the result of the mix stage
    BufferTexture solved;      ///< the rotations of one constraint
    BufferTexture corrections; ///< those of all constraints so far, see CorrectionPlace
    std::vector<AffineMatrix> onCpu; ///< memory of evaluateOnCpu()
    std::uint64_t draws = 0;         ///< of all passes so far
    // See PosePipeline::Options.
    bool drawsTriangles = true;
    bool usesBaseInstances = false;

private:
    std::map<std::tuple<Stage, PoseVariant, ConstraintShape>, std::unique_ptr<FeedbackPass>> _passes;
};

} // namespace osgGpuAnimation
