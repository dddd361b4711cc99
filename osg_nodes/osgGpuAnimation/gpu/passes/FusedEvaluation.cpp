// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/passes/FusedEvaluation.h>

#include <osgGpuAnimation/animation/constraints/ConstraintPlan.h>

#include <layout.glsl>

#include <algorithm>

namespace osgGpuAnimation
{

FusedEvaluation::FusedEvaluation(EvaluationContext& context, FeedbackScope& scope, FeedbackVertexArrays::Names& arrays,
                                 const PoseBatch& batch, AnimationBuffers& buffers, PosePalette::Chunk& chunk)
    : _context(context), _scope(scope), _arrays(arrays), _batch(batch), _set(batch.set()), _buffers(buffers),
      _chunk(chunk),
      _constraints(batch.needs().constraints != 0 ? &buffers.constraints(batch.set(), batch.needs().constraints)
                                                  : nullptr),
      _garmentEntries(_set.paletteSize() - _set.levels().back()), _variant(PoseVariant::of(batch, buffers.isModest()))
{
    for (std::size_t level = 0; level < _set.levelCount(); ++level)
    {
        _scratchPlaces.push_back(_oddEntries);
        if (isOdd(level)) _oddEntries += levelEnd(level) - levelBegin(level);
    }
    if (chunk.hasSamplesAsAttributes()) _variant.sampleCount = static_cast<int>(chunk.sampleStride);
}

bool FusedEvaluation::run()
{
    reserve();
    _chunk.bindInstances(*_context.gl, _arrays);
    for (std::size_t level = 0; level < _set.levelCount(); ++level)
        if (!solveConstraints(level) || !computeLevel(level)) return false;
    gatherOddLevels();
    return _garmentEntries == 0 || computeGarments();
}

void FusedEvaluation::reserve()
{
    if (const std::size_t count = std::max(_oddEntries, _garmentEntries); count > 0)
        _context.scratch.reserve(count * _chunk.width * EvaluationContext::matrixBytes);
    if (_constraints)
        _context.corrections.reserve(_constraints->plan().correctionCount * _chunk.width *
                                     EvaluationContext::rotationBytes);
}

PoseVariant FusedEvaluation::variantOf(std::size_t level) const
{
    PoseVariant variant = _variant;
    variant.isRootLevel = level == 0;
    variant.hasRoots = level == 0 && !_chunk.uploadedRootMatrices.empty();
    variant.hasWeights = level == 0 && _variant.hasWeights;
    variant.setMotion(_buffers.levels()[level]);
    return variant;
}

/// Makes the pass current with the input of the mix stage. False: it does not compile.
bool FusedEvaluation::use(FeedbackPass& pass)
{
    if (!pass.valid()) return false;
    if (&pass != _current) _context.useMixInput(_scope, pass, _set, _buffers, _chunk);
    _current = &pass;
    return true;
}

/// The buffer with the level above, and its first entry there.
void FusedEvaluation::setParents(FeedbackPass& pass, std::size_t level)
{
    const bool isInScratch = !isOdd(level) && level > 0;
    const std::size_t firstParent = isInScratch ? levelBegin(level - 1) - _scratchPlaces[level - 1] : 0;
    pass.setTexture(_scope, "parentLevels", unitPrevious, (isOdd(level) ? _chunk.palette : _context.scratch).texture());
    pass.setInt("firstParent", static_cast<int>(firstParent));
}

bool FusedEvaluation::computeLevel(std::size_t level)
{
    for (std::size_t first = levelBegin(level), end = first; first < levelEnd(level); first = end)
    {
        end = _constraints ? _constraints->endOfRun(first, levelEnd(level)) : levelEnd(level);
        if (!computeRun(level, first, end)) return false;
    }
    return true;
}

/// Entries of a level of which constraints correct all or none.
bool FusedEvaluation::computeRun(std::size_t level, std::size_t first, std::size_t end)
{
    PoseVariant variant = variantOf(level);
    variant.hasCorrections = _constraints && _constraints->isCorrected(first);
    if (variant.hasCorrections) variant.hasWeights = false;
    FeedbackPass& pass = _context.pass(EvaluationContext::Stage::Pose, variant);
    if (!use(pass)) return false;
    setParents(pass, level);
    if (variant.hasCorrections) pass.setTexture(_scope, "corrections", unitCorrections, _context.corrections.texture());
    const std::size_t place = isOdd(level) ? _scratchPlaces[level] : levelBegin(level);
    drawEntries(pass, first, end - first, isOdd(level) ? _context.scratch : _chunk.palette,
                place + first - levelBegin(level));
    return true;
}

/// Computes palette entries of all instances. place: of the first one in the output, in entries.
void FusedEvaluation::drawEntries(FeedbackPass& pass, std::size_t first, std::size_t count, const BufferTexture& out,
                                  std::size_t place)
{
    const BufferTexture& entries = _constraints ? _constraints->entries() : _buffers.entries();
    const bool canOffset = _context.usesBaseInstances;
    if (const std::size_t bound = canOffset ? 0 : first;
        _arrays.entries != entries.serial() || _arrays.firstEntry != bound)
    {
        const std::size_t stride = POSE_TEXELS_PER_ENTRY * BufferTexture::texelBytes;
        entries.bindAttributes(POSE_HEAD_LOCATION, POSE_TEXELS_PER_ENTRY, stride, bound * stride, 1);
        _arrays.entries = entries.serial();
        _arrays.firstEntry = bound;
    }
    pass.runInstanced(_chunk.width, count, canOffset ? first : 0, out.buffer(),
                      place * _chunk.width * EvaluationContext::matrixBytes, _context.drawsTriangles);
    ++_context.draws;
}

bool FusedEvaluation::solveConstraints(std::size_t level)
{
    for (; _constraints && _constraints->isSolvedBefore(level, _solvedSteps); ++_solvedSteps)
        if (!solveConstraint(_solvedSteps, level)) return false;
    return true;
}

// The draw reads the rotations of the constraints before, so it writes to a buffer of its own.
bool FusedEvaluation::solveConstraint(std::size_t step, std::size_t level)
{
    const ConstraintStep& plan = _constraints->plan().steps[step];
    const ConstraintShape shape(plan, _batch);
    PoseVariant variant = variantOf(level);
    variant.setMotion(plan.level == 0 ? _buffers.anyTrack() : _buffers.levels()[plan.level]);
    variant.hasWeights = false;
    FeedbackPass& pass = _context.pass(EvaluationContext::Stage::Constrain, variant, shape);
    if (!use(pass)) return false;
    const std::size_t jointBytes = _chunk.width * EvaluationContext::rotationBytes;
    const auto joints = static_cast<std::size_t>(shape.chainLength);
    _context.solved.reserve(joints * jointBytes);
    setParents(pass, level);
    pass.setVectors("constraint", _constraints->constants(step));
    if (shape.aboveLength > 0)
    {
        pass.setTexture(_scope, "jointsAbove", unitJointsAbove, _constraints->jointsAbove().texture());
        pass.setInt("firstAbove", _constraints->firstAbove(step));
    }
    pass.setTexture(_scope, "corrections", unitCorrections, _context.corrections.texture());
    pass.setTexture(_scope, "targets", unitTargets, _chunk.targets.texture());
    pass.setInt("targetStride", static_cast<int>(_set.constraints().size()));
    pass.runInstanced(_chunk.width, 1, 0, _context.solved.buffer(), 0);
    ++_context.draws;
    _context.copy(_context.solved, _context.corrections, jointBytes, {{0, plan.firstCorrection, joints}});
    return true;
}

void FusedEvaluation::gatherOddLevels()
{
    std::vector<EvaluationContext::UnitCopy> copies;
    for (std::size_t level = 1; level < _set.levelCount(); level += 2)
        copies.push_back({_scratchPlaces[level], levelBegin(level), levelEnd(level) - levelBegin(level)});
    _context.copy(_context.scratch, _chunk.palette, _chunk.width * EvaluationContext::matrixBytes, copies);
}

// The parents of the garments' entries are in any level, so the draw reads the whole palette and writes to the scratch
// buffer.
bool FusedEvaluation::computeGarments()
{
    PoseVariant variant = _variant;
    variant.hasWeights = false;
    variant.setMotion(_buffers.levels().back());
    FeedbackPass& pass = _context.pass(EvaluationContext::Stage::Pose, variant);
    if (!use(pass)) return false;
    pass.setTexture(_scope, "parentLevels", unitPrevious, _chunk.palette.texture());
    pass.setInt("firstParent", 0);
    const std::size_t first = _set.levels().back();
    drawEntries(pass, first, _garmentEntries, _context.scratch, 0);
    _context.copy(_context.scratch, _chunk.palette, _chunk.width * EvaluationContext::matrixBytes,
                  {{0, first, _garmentEntries}});
    return true;
}

} // namespace osgGpuAnimation
