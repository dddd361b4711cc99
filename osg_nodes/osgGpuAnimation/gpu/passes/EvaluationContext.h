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
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

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

    FeedbackPass& posePass(const PoseVariant& variant);
    FeedbackPass& mixPass(const PoseVariant& variant);
    FeedbackPass& constraintPass(const ConstraintShape& shape, const PoseVariant& variant);
    FeedbackPass& localPass();
    FeedbackPass& worldPass();

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
    using Pass = std::unique_ptr<FeedbackPass>;
    template <typename Action>
    void forEachPass(Action action);

    std::map<PoseVariant, Pass> _posePasses, _mixPasses;
    std::map<std::pair<ConstraintShape, PoseVariant>, Pass> _constraintPasses;
    Pass _localPass, _worldPass;
};

} // namespace osgGpuAnimation
