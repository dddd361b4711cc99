// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/passes/EvaluationContext.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The fused form: mix, local and world in one pass, level by level, for all instances of a chunk. Instances are the
/// vertices of a draw, the entries of a level its GL instances.
///
/// A buffer must not be read while feedback writes to it, so even levels are written to the palette and odd levels, one
/// after the other, to the scratch buffer; each reads its parents from the other buffer. At the end the odd levels are
/// copied to their places in the palette.
class FusedEvaluation
{
public:
    /// arrays: of the scope's state.
    FusedEvaluation(EvaluationContext& context, FeedbackScope& scope, FeedbackVertexArrays::Names& arrays,
                    const PoseBatch& batch, AnimationBuffers& buffers, PosePalette::Chunk& chunk);

    /// False: a pass does not compile.
    bool run();

private:
    void reserve();
    bool computeLevel(std::size_t level);
    bool solveConstraints(std::size_t level);
    bool solveConstraint(std::size_t step, std::size_t level);
    bool computeRun(std::size_t level, std::size_t first, std::size_t end);
    void gatherOddLevels();
    bool computeGarments();

    bool isOdd(std::size_t level) const { return level % 2 != 0; }
    std::size_t levelBegin(std::size_t level) const { return _set.levels()[level]; } ///< palette entry
    std::size_t levelEnd(std::size_t level) const { return _set.levels()[level + 1]; }
    PoseVariant variantOf(std::size_t level) const;
    bool use(FeedbackPass& pass);
    void setParents(FeedbackPass& pass, std::size_t level);
    void drawEntries(FeedbackPass& pass, std::size_t first, std::size_t count, const BufferTexture& out,
                     std::size_t place);

    EvaluationContext& _context;
    FeedbackScope& _scope;
    FeedbackVertexArrays::Names& _arrays;
    const PoseBatch& _batch;
    const AnimationSet& _set;
    AnimationBuffers& _buffers;
    PosePalette::Chunk& _chunk;
    const ConstraintBuffers* _constraints;   ///< null: none has an effect
    std::vector<std::size_t> _scratchPlaces; ///< by level, for the odd ones: the first entry in the scratch buffer
    std::size_t _oddEntries = 0;             ///< entries of all odd levels
    std::size_t _garmentEntries = 0;         ///< entries behind the levels
    PoseVariant _variant;                    ///< of the batch
    const FeedbackPass* _current = nullptr;  ///< the pass in use with its mix input
    std::size_t _solvedSteps = 0;            ///< of the constraints
};

} // namespace osgGpuAnimation
