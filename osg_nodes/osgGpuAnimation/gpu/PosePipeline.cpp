// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osgGpuAnimation/animation/constraints/ConstraintPlan.h>
#include <osgGpuAnimation/gpu/buffers/AnimationBuffers.h>
#include <osgGpuAnimation/gpu/buffers/PosePalette.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
#include <osgGpuAnimation/gpu/passes/PoseVariant.h>

#include <layout.glsl>
#include <ShaderSources.h>

#include <osg/ContextData>
#include <osg/Notify>

#include <algorithm>
#include <map>

#ifndef GL_MAX_TEXTURE_BUFFER_SIZE
#define GL_MAX_TEXTURE_BUFFER_SIZE 0x8C2B
#endif
#ifndef GL_COPY_READ_BUFFER
#define GL_COPY_READ_BUFFER 0x8F36
#define GL_COPY_WRITE_BUFFER 0x8F37
#endif

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t matrixBytes = sizeof(AffineMatrix);
constexpr int unitKeyframes = 0, unitSamples = 1, unitEntries = 2, unitRoots = 3, unitPrevious = 4, unitMasks = 5;
constexpr int unitPosed = 6;
constexpr int unitCorrections = 7, unitJointsAbove = 8, unitTargets = 9; // bound by batches with constraints only
static_assert(unitTargets < FeedbackScope::unitCount, "the scope unbinds all units");
constexpr std::size_t rotationBytes = BufferTexture::texelBytes;

constexpr std::initializer_list<const char*> rowOutputs{"row0", "row1", "row2"};

/// The number of palette entries in the levels 1, 3, 5 …
std::size_t oddEntries(const AnimationSet& set)
{
    std::size_t count = 0;
    for (std::size_t level = 1; level < set.levelCount(); level += 2)
        count += set.levels()[level + 1] - set.levels()[level];
    return count;
}

/// The shared buffers of a set and its palettes by slot.
struct SetResources
{
    void release()
    {
        for (const std::unique_ptr<PosePalette>& palette : palettes)
            palette->release();
        if (buffers) buffers->release();
    }

    std::weak_ptr<const AnimationSet> set;
    std::unique_ptr<AnimationBuffers> buffers;          ///< null: too large for the context
    std::vector<std::unique_ptr<PosePalette>> palettes; ///< by slot
    bool isMaskLimitReported = false;
};

using Passes = std::map<PoseVariant, std::unique_ptr<FeedbackPass>>;
using ConstraintPasses = std::map<std::pair<ConstraintShape, PoseVariant>, std::unique_ptr<FeedbackPass>>;

/// The number of rotations that the constraints of a set may correct.
std::size_t correctionsOf(const AnimationSet& set)
{
    std::size_t count = 0;
    for (const ConstraintChain& chain : set.constraintChains())
        count += chain.joints.size();
    return count;
}

/// Units (palette entries, or joints, of all instances) on their way from one buffer to another.
struct UnitCopy
{
    std::size_t from, to; ///< the first unit in each
    std::size_t count;
};

/// The input of the draws of one level of the palette.
struct LevelInput
{
    FeedbackScope& scope;
    const AnimationSet& set;
    const AnimationBuffers& buffers;
    const ConstraintBuffers* constraints; ///< null: none
    const PosePalette::Chunk& chunk;
    GLuint parentLevels;     ///< texture
    std::size_t firstParent; ///< the first palette entry in it
};

} // namespace

struct PosePipeline::Parts
{
    Parts(PosePipeline& pipeline, osg::GLExtensions& gl)
        : pipeline(pipeline), gl(&gl), vertexArrays(gl), scratch(gl, GL_RGBA32F_ARB), mixedTracks(gl, GL_RGBA32F_ARB),
          solved(gl, GL_RGBA32F_ARB), corrections(gl, GL_RGBA32F_ARB)
    {
        osg::setGLExtensionFuncPtr(copyBufferSubData, "glCopyBufferSubData");
    }

    FeedbackPass& posePass(const PoseVariant& variant);
    FeedbackPass& mixPass(const PoseVariant& variant);
    FeedbackPass& constraintPass(const ConstraintShape& shape, const PoseVariant& variant);
    void makeSeparatePasses();
    void forgetUnusedSets();
    std::size_t chunkCapacity(const PoseBatch& batch) const;
    bool hasRoomForMasks(SetResources& resources, const PoseBatch& batch) const;
    SetResources& resourcesOf(const PoseBatch& batch);
    bool evaluateFused(FeedbackScope& scope, FeedbackVertexArrays::Names& arrays, const PoseBatch& batch,
                       AnimationBuffers& buffers, PosePalette::Chunk& chunk);
    bool solveConstraint(const LevelInput& input, const PoseBatch& batch, std::size_t number, PoseVariant variant);
    bool evaluateSeparate(FeedbackScope& scope, const PoseBatch& batch, const AnimationBuffers& buffers,
                          PosePalette::Chunk& chunk);
    void useMixInput(FeedbackScope& scope, FeedbackPass& pass, const AnimationSet& set, const AnimationBuffers& buffers,
                     const PosePalette::Chunk& chunk);
    void drawEntries(FeedbackPass& pass, FeedbackVertexArrays::Names& arrays, const BufferTexture& entries,
                     std::size_t first, std::size_t count, std::size_t width, const BufferTexture& out,
                     std::size_t place);
    bool evaluateGarments(FeedbackScope& scope, FeedbackVertexArrays::Names& arrays, const AnimationSet& set,
                          const AnimationBuffers& buffers, PosePalette::Chunk& chunk, PoseVariant variant);
    void gatherOddLevels(const AnimationSet& set, const PosePalette::Chunk& chunk);
    void copy(const BufferTexture& from, const BufferTexture& to, std::size_t unitBytes,
              const std::vector<UnitCopy>& copies) const;
    void runSeparate(FeedbackPass& pass, std::size_t count, const BufferTexture& out);

    PosePipeline& pipeline;
    osg::GLExtensions* gl;
    void(GL_APIENTRY* copyBufferSubData)(GLenum, GLenum, GLintptr, GLintptr, GLsizeiptr) = nullptr;
    FeedbackVertexArrays vertexArrays;
    Passes posePasses;
    Passes mixPasses;
    ConstraintPasses constraintPasses;
    std::unique_ptr<FeedbackPass> localPass;
    std::unique_ptr<FeedbackPass> worldPass;
    BufferTexture scratch;     ///< fused: the odd levels, one after the other, then garments; separate: local matrices
    BufferTexture mixedTracks; ///< separate: the result of the mix stage
    BufferTexture solved;      ///< the rotations of one constraint
    BufferTexture corrections; ///< those of all constraints so far, see CorrectionPlace
    std::map<const AnimationSet*, SetResources> sets;
};

PosePipeline::PosePipeline(unsigned int contextId) : osg::GraphicsObjectManager("PosePipeline", contextId)
{
    osg::GLExtensions& gl = *osg::GLExtensions::Get(contextId, true);
    _parts = std::make_unique<Parts>(*this, gl);
    GLint maxTexels = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &maxTexels);
    _options.maxTexels = static_cast<std::size_t>(std::max(maxTexels, 0));
    _isSupported = gl.glVersion >= 3.3f && gl.glBeginTransformFeedback && gl.glTexBuffer && _parts->copyBufferSubData;
    if (!_isSupported)
        OSG_WARN << "osgGpuAnimation: this context has OpenGL " << gl.glVersion
                 << "; animated characters need 3.3 with transform feedback and are not drawn" << std::endl;
}

PosePipeline::~PosePipeline() = default;

PosePipeline* PosePipeline::of(osg::State& state)
{
    PosePipeline* pipeline = osg::get<PosePipeline>(state.getContextID());
    return pipeline->_isSupported ? pipeline : nullptr;
}

FeedbackPass& PosePipeline::Parts::posePass(const PoseVariant& variant)
{
    std::unique_ptr<FeedbackPass>& pass = posePasses[variant];
    if (!pass) pass = variant.makePosePass(*gl);
    return *pass;
}

FeedbackPass& PosePipeline::Parts::mixPass(const PoseVariant& variant)
{
    std::unique_ptr<FeedbackPass>& pass = mixPasses[variant];
    if (!pass) pass = variant.makeMixPass(*gl);
    return *pass;
}

FeedbackPass& PosePipeline::Parts::constraintPass(const ConstraintShape& shape, const PoseVariant& variant)
{
    std::unique_ptr<FeedbackPass>& pass = constraintPasses[{shape, variant}];
    if (!pass) pass = variant.makeConstraintPass(*gl, shape);
    return *pass;
}

void PosePipeline::Parts::makeSeparatePasses()
{
    if (localPass) return;
    using namespace shaders;
    localPass.reset(new FeedbackPass(*gl, "local", {local_glsl, local_vert}, rowOutputs));
    worldPass.reset(
        new FeedbackPass(*gl, "world", {"const bool hasLimits = true;\n", world_glsl, world_vert}, rowOutputs));
}

SetResources& PosePipeline::Parts::resourcesOf(const PoseBatch& batch)
{
    const AnimationSet& set = batch.set();
    SetResources& resources = sets[&set];
    if (!resources.set.expired()) return resources;

    resources.release();
    resources = SetResources{batch.sharedSet(), nullptr, {}, false};
    const PackedKeyframes keyframes(set);
    const std::size_t keyframeTexels = keyframes.texels().size();
    const std::size_t entryTexels = set.paletteSize() * POSE_TEXELS_PER_ENTRY;
    if (std::max(keyframeTexels, entryTexels) <= pipeline._options.maxTexels)
        resources.buffers = std::make_unique<AnimationBuffers>(*gl, set, keyframes);
    else
        OSG_WARN << "osgGpuAnimation: an animation set needs buffers of " << keyframeTexels
                 << " texels (keyframes) and " << entryTexels << " (palette entries), this context takes at most "
                 << pipeline._options.maxTexels << "; its characters are not drawn" << std::endl;
    return resources;
}

bool PosePipeline::evaluate(osg::State& state, const PoseBatch& batch, std::size_t slot)
{
    _parts->forgetUnusedSets();
    if (!batch.sharedSet()) return false;
    SetResources& resources = _parts->resourcesOf(batch);
    if (!resources.buffers) return false;
    while (resources.palettes.size() <= slot)
        resources.palettes.push_back(std::make_unique<PosePalette>(*_parts->gl));

    const AnimationSet& set = batch.set();
    if (batch.needs().masks)
    {
        if (!_parts->hasRoomForMasks(resources, batch))
        {
            resources.palettes[slot]->invalidate();
            return false;
        }
        resources.buffers->updateMasks(set, batch.masks());
    }
    const std::vector<PosePalette::Chunk*> changed =
        resources.palettes[slot]->upload(batch, _parts->chunkCapacity(batch), _counters.bytesUploaded);
    if (changed.empty()) return true;

    FeedbackVertexArrays::Names& vertexArrays = _parts->vertexArrays.of(state);
    const bool isConstrained = batch.needs().constraints != 0;
    const bool isFused = _options.form == Form::Fused || isConstrained;
    FeedbackScope scope(state, isFused ? vertexArrays.pose : vertexArrays.empty);
    for (PosePalette::Chunk* chunk : changed)
    {
        chunk->palette.reserve(set.paletteSize() * chunk->width * matrixBytes);
        chunk->isEvaluated = isFused ? _parts->evaluateFused(scope, vertexArrays, batch, *resources.buffers, *chunk)
                                     : _parts->evaluateSeparate(scope, batch, *resources.buffers, *chunk);
        if (!chunk->isEvaluated) return false;
        _counters.instancesEvaluated += chunk->size;
    }
    return true;
}

std::size_t PosePipeline::chunkCapacity(const AnimationSet& set, const Options& options)
{
    const std::size_t widest = std::max(set.paletteSize(), options.form == Form::Separate ? set.trackCount() : 0);
    const std::size_t targetTexels = set.constraints().size() * POSE_TEXELS_PER_TARGET;
    const std::size_t texels =
        std::max({POSE_TEXELS_PER_MATRIX * widest, correctionsOf(set), targetTexels, std::size_t(1)});
    std::size_t capacity = std::max<std::size_t>(std::min(options.maxTexels / texels, options.chunkSize), 1);
    while (PosePalette::widthOf(capacity) > capacity)
        --capacity;
    return capacity;
}

std::size_t PosePipeline::Parts::chunkCapacity(const PoseBatch& batch) const
{
    Options options = pipeline._options;
    const std::size_t texels = std::max(PosePalette::posedTexels(batch), batch.sampleStride());
    options.chunkSize = std::min(options.chunkSize, options.maxTexels / texels);
    return PosePipeline::chunkCapacity(batch.set(), options);
}

bool PosePipeline::Parts::hasRoomForMasks(SetResources& resources, const PoseBatch& batch) const
{
    const std::size_t texels = AnimationBuffers::texelsPerMask(batch.set()) * batch.masks().size();
    if (texels <= pipeline._options.maxTexels) return true;
    if (!resources.isMaskLimitReported)
        OSG_WARN << "osgGpuAnimation: the masks of an animation set need a buffer of " << texels
                 << " texels, this context takes at most " << pipeline._options.maxTexels
                 << "; its characters are not drawn" << std::endl;
    resources.isMaskLimitReported = true;
    return false;
}

void PosePipeline::Parts::useMixInput(FeedbackScope& scope, FeedbackPass& pass, const AnimationSet& set,
                                      const AnimationBuffers& buffers, const PosePalette::Chunk& chunk)
{
    pass.use();
    pass.setTexture(scope, "keyframes", unitKeyframes, buffers.keyframes().texture());
    pass.setTexture(scope, "samples", unitSamples, chunk.samples.texture());
    pass.setTexture(scope, "masks", unitMasks, buffers.masks().texture());
    pass.setInt("maskStride", static_cast<int>(AnimationBuffers::texelsPerMask(set)));
    if (!chunk.uploadedPosed.empty())
    {
        pass.setTexture(scope, "posedKeyframes", unitPosed, chunk.posed.texture());
        pass.setInt("firstPosed", static_cast<int>(chunk.firstPosed));
        pass.setInt("trackCount", static_cast<int>(set.trackCount()));
    }
    pass.setInt("sampleStride", static_cast<int>(chunk.sampleStride));
    pass.setInt("instanceCount", static_cast<int>(chunk.width));
    pass.setInt("restTexel", static_cast<int>(buffers.restTexel()));
    pass.setInt("jointCount", static_cast<int>(set.skeleton().jointCount()));
}

// A buffer must not be read while feedback writes to it, so even levels are written to the palette and odd levels, one
// after the other, to the scratch buffer. At the end the odd levels are copied to their places in the palette.
bool PosePipeline::Parts::evaluateFused(FeedbackScope& scope, FeedbackVertexArrays::Names& arrays,
                                        const PoseBatch& batch, AnimationBuffers& buffers, PosePalette::Chunk& chunk)
{
    const AnimationSet& set = batch.set();
    const std::uint64_t active = batch.needs().constraints;
    const ConstraintBuffers* constraints = active != 0 ? &buffers.constraints(set, active) : nullptr;
    const std::size_t garmentEntries = set.paletteSize() - set.levels().back();
    if (const std::size_t most = std::max(oddEntries(set), garmentEntries); most > 0)
        scratch.reserve(most * chunk.width * matrixBytes);
    if (constraints) corrections.reserve(constraints->plan().correctionCount * chunk.width * rotationBytes);
    const BufferTexture& entries = constraints ? constraints->entries() : buffers.entries();
    chunk.bindInstances(*gl, arrays);
    PoseVariant variant = PoseVariant::of(batch, buffers.isModest());
    if (chunk.hasSamplesAsAttributes()) variant.sampleCount = static_cast<int>(chunk.sampleStride);
    variant.isRootLevel = true;
    variant.hasRoots = !chunk.uploadedRootMatrices.empty();
    const std::vector<std::size_t>& levels = set.levels();
    const FeedbackPass* current = nullptr;
    std::size_t solvedSteps = 0; // of the constraints
    std::size_t firstParent = 0; // first palette entry in the buffer that this level reads
    std::size_t oddEntry = 0;    // entries in the scratch buffer so far
    for (std::size_t level = 0; level < set.levelCount(); ++level)
    {
        if (level == 1) variant.isRootLevel = variant.hasRoots = variant.hasWeights = false;
        const bool isOdd = level % 2 != 0;
        const std::size_t count = levels[level + 1] - levels[level];
        const LevelInput input{scope,
                               set,
                               buffers,
                               constraints,
                               chunk,
                               (isOdd ? chunk.palette : scratch).texture(),
                               isOdd ? 0 : firstParent};
        for (; constraints && constraints->isSolvedBefore(level, solvedSteps); ++solvedSteps, current = nullptr)
            if (!solveConstraint(input, batch, solvedSteps, variant)) return false;
        variant.setMotion(buffers.levels()[level]);
        const BufferTexture& out = isOdd ? scratch : chunk.palette;
        const std::size_t outBegin = isOdd ? oddEntry : levels[level];
        for (std::size_t first = levels[level], end = first; first < levels[level + 1]; first = end)
        {
            PoseVariant present = variant;
            end = constraints ? constraints->endOfRun(first, levels[level + 1]) : levels[level + 1];
            present.hasCorrections = constraints && constraints->isCorrected(first);
            if (present.hasCorrections) present.hasWeights = false;
            FeedbackPass& pass = posePass(present);
            if (!pass.valid()) return false;
            if (&pass != current) useMixInput(scope, pass, set, buffers, chunk);
            current = &pass;
            pass.setTexture(scope, "parentLevels", unitPrevious, input.parentLevels);
            pass.setInt("firstParent", static_cast<int>(input.firstParent));
            if (present.hasCorrections) pass.setTexture(scope, "corrections", unitCorrections, corrections.texture());
            drawEntries(pass, arrays, entries, first, end - first, chunk.width, out, outBegin + first - levels[level]);
        }
        if (!isOdd) continue;
        firstParent = levels[level] - oddEntry;
        oddEntry += count;
    }
    gatherOddLevels(set, chunk);
    return garmentEntries == 0 || evaluateGarments(scope, arrays, set, buffers, chunk, variant);
}

// The parents of the garments' entries are in any level, so the draw reads the whole palette and writes to the scratch
// buffer.
bool PosePipeline::Parts::evaluateGarments(FeedbackScope& scope, FeedbackVertexArrays::Names& arrays,
                                           const AnimationSet& set, const AnimationBuffers& buffers,
                                           PosePalette::Chunk& chunk, PoseVariant variant)
{
    variant.isRootLevel = variant.hasRoots = variant.hasWeights = variant.hasCorrections = false;
    variant.setMotion(buffers.levels().back());
    FeedbackPass& pass = posePass(variant);
    if (!pass.valid()) return false;
    const std::size_t first = set.levels().back(), count = set.paletteSize() - first;
    useMixInput(scope, pass, set, buffers, chunk);
    pass.setTexture(scope, "parentLevels", unitPrevious, chunk.palette.texture());
    pass.setInt("firstParent", 0);
    drawEntries(pass, arrays, buffers.entries(), first, count, chunk.width, scratch, 0);
    copy(scratch, chunk.palette, chunk.width * matrixBytes, {{0, first, count}});
    return true;
}

// Computes palette entries of `width` instances. place: of the first one in the output, in entries.
void PosePipeline::Parts::drawEntries(FeedbackPass& pass, FeedbackVertexArrays::Names& arrays,
                                      const BufferTexture& entries, std::size_t first, std::size_t count,
                                      std::size_t width, const BufferTexture& out, std::size_t place)
{
    const bool canOffset = FeedbackPass::canOffsetInstances(*gl);
    if (const std::size_t bound = canOffset ? 0 : first;
        arrays.entries != entries.serial() || arrays.firstEntry != bound)
    {
        const std::size_t stride = POSE_TEXELS_PER_ENTRY * BufferTexture::texelBytes;
        entries.bindAttributes(POSE_HEAD_LOCATION, POSE_TEXELS_PER_ENTRY, stride, bound * stride, 1);
        arrays.entries = entries.serial();
        arrays.firstEntry = bound;
    }
    pass.runInstanced(width, count, canOffset ? first : 0, out.buffer(), place * width * matrixBytes);
    ++pipeline._counters.feedbackDraws;
}

// The draw reads the rotations of the constraints before, so it writes to a buffer of its own.
bool PosePipeline::Parts::solveConstraint(const LevelInput& input, const PoseBatch& batch, std::size_t number,
                                          PoseVariant variant)
{
    const ConstraintStep& step = input.constraints->plan().steps[number];
    const ConstraintShape shape(step, batch);
    variant.setMotion(step.level == 0 ? input.buffers.anyTrack() : input.buffers.levels()[step.level]);
    variant.hasWeights = variant.hasCorrections = false;
    FeedbackPass& pass = constraintPass(shape, variant);
    if (!pass.valid()) return false;
    const std::size_t jointBytes = input.chunk.width * rotationBytes;
    const auto joints = static_cast<std::size_t>(shape.chainLength);
    FeedbackScope& scope = input.scope;
    solved.reserve(joints * jointBytes);
    useMixInput(scope, pass, input.set, input.buffers, input.chunk);
    pass.setTexture(scope, "parentLevels", unitPrevious, input.parentLevels);
    pass.setInt("firstParent", static_cast<int>(input.firstParent));
    pass.setVectors("constraint", input.constraints->constants(number));
    if (shape.aboveLength > 0)
    {
        pass.setTexture(scope, "jointsAbove", unitJointsAbove, input.constraints->jointsAbove().texture());
        pass.setInt("firstAbove", input.constraints->firstAbove(number));
    }
    pass.setTexture(scope, "corrections", unitCorrections, corrections.texture());
    pass.setTexture(scope, "targets", unitTargets, input.chunk.targets.texture());
    pass.setInt("targetStride", static_cast<int>(input.set.constraints().size()));
    pass.runInstanced(input.chunk.width, 1, 0, solved.buffer(), 0);
    ++pipeline._counters.feedbackDraws;
    copy(solved, corrections, jointBytes, {{0, step.firstCorrection, joints}});
    return true;
}

void PosePipeline::Parts::gatherOddLevels(const AnimationSet& set, const PosePalette::Chunk& chunk)
{
    const std::vector<std::size_t>& levels = set.levels();
    std::vector<UnitCopy> copies;
    std::size_t from = 0;
    for (std::size_t level = 1; level < set.levelCount(); level += 2)
    {
        copies.push_back({from, levels[level], levels[level + 1] - levels[level]});
        from += copies.back().count;
    }
    copy(scratch, chunk.palette, chunk.width * matrixBytes, copies);
}

void PosePipeline::Parts::copy(const BufferTexture& from, const BufferTexture& to, std::size_t unitBytes,
                               const std::vector<UnitCopy>& copies) const
{
    if (copies.empty()) return;
    gl->glBindBuffer(GL_COPY_READ_BUFFER, from.buffer());
    gl->glBindBuffer(GL_COPY_WRITE_BUFFER, to.buffer());
    for (const UnitCopy& copy : copies)
        copyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(copy.from * unitBytes),
                          static_cast<GLintptr>(copy.to * unitBytes), static_cast<GLsizeiptr>(copy.count * unitBytes));
    gl->glBindBuffer(GL_COPY_READ_BUFFER, 0);
    gl->glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void PosePipeline::Parts::runSeparate(FeedbackPass& pass, std::size_t count, const BufferTexture& out)
{
    pass.run(0, count, out.buffer(), 0);
    ++pipeline._counters.feedbackDraws;
}

bool PosePipeline::Parts::evaluateSeparate(FeedbackScope& scope, const PoseBatch& batch,
                                           const AnimationBuffers& buffers, PosePalette::Chunk& chunk)
{
    const AnimationSet& set = batch.set();
    const std::size_t trackVertices = set.trackCount() * chunk.width;
    mixedTracks.reserve(trackVertices * sizeof(JointTransform));
    scratch.reserve(trackVertices * matrixBytes);

    makeSeparatePasses();
    PoseVariant variant = PoseVariant::of(batch, buffers.isModest());
    variant.setMotion(buffers.anyTrack());
    variant.translationMotion = std::max(variant.translationMotion, PartMotion::Constant);
    variant.scaleMotion = std::max(variant.scaleMotion, PartMotion::Constant);
    FeedbackPass& mixing = mixPass(variant);
    if (!mixing.valid() || !localPass->valid() || !worldPass->valid()) return false;
    useMixInput(scope, mixing, set, buffers, chunk);
    runSeparate(mixing, trackVertices, mixedTracks);

    localPass->use();
    localPass->setTexture(scope, "mixedTracks", unitPrevious, mixedTracks.texture());
    localPass->setInt("instanceCount", static_cast<int>(chunk.width));
    localPass->setInt("jointCount", static_cast<int>(set.skeleton().jointCount()));
    runSeparate(*localPass, trackVertices, scratch);

    worldPass->use();
    worldPass->setInt("instanceCount", static_cast<int>(chunk.width));
    worldPass->setTexture(scope, "entries", unitEntries, buffers.entries().texture());
    worldPass->setTexture(scope, "roots", unitRoots, chunk.roots.texture());
    worldPass->setInt("rootCount", static_cast<int>(chunk.uploadedRootMatrices.size()));
    worldPass->setTexture(scope, "localMatrices", unitPrevious, scratch.texture());
    runSeparate(*worldPass, set.paletteSize() * chunk.width, chunk.palette);
    return true;
}

PalettePlace PosePipeline::place(const AnimationSet& set, std::size_t slot, std::size_t instance) const
{
    const auto known = _parts->sets.find(&set);
    if (known == _parts->sets.end() || slot >= known->second.palettes.size()) return {};
    return known->second.palettes[slot]->place(instance);
}

std::vector<AffineMatrix> PosePipeline::readPalette(osg::State& state, const AnimationSet& set, std::size_t slot,
                                                    std::size_t instance) const
{
    const PalettePlace where = place(set, slot, instance);
    std::vector<AffineMatrix> entries(where.texture == 0 ? 0 : set.paletteSize());
    if (entries.empty()) return entries;
    const auto& palette = *_parts->sets.at(&set).palettes[slot];
    for (const std::unique_ptr<PosePalette::Chunk>& chunk : palette.chunks())
        if (chunk->palette.texture() == where.texture)
            _parts->gl->glBindBuffer(GL_TEXTURE_BUFFER, chunk->palette.buffer());
    for (std::size_t entry = 0; entry < entries.size(); ++entry)
        _parts->gl->glGetBufferSubData(GL_TEXTURE_BUFFER,
                                       static_cast<GLintptr>((entry * static_cast<std::size_t>(where.stride) +
                                                              static_cast<std::size_t>(where.instance)) *
                                                             matrixBytes),
                                       matrixBytes, &entries[entry]);
    _parts->gl->glBindBuffer(GL_TEXTURE_BUFFER, 0);
    state.checkGLErrors("PosePipeline::readPalette");
    return entries;
}

void PosePipeline::Parts::forgetUnusedSets()
{
    for (auto resources = sets.begin(); resources != sets.end();)
    {
        if (!resources->second.set.expired())
        {
            ++resources;
            continue;
        }
        resources->second.release();
        resources = sets.erase(resources);
    }
}

void PosePipeline::flushDeletedGLObjects(double, double&)
{
    _parts->forgetUnusedSets();
}

void PosePipeline::flushAllDeletedGLObjects()
{
    _parts->forgetUnusedSets();
}

void PosePipeline::deleteAllGLObjects()
{
    for (auto& [set, resources] : _parts->sets)
        resources.release();
    for (Passes* passes : {&_parts->posePasses, &_parts->mixPasses})
        for (auto& [variant, pass] : *passes)
            pass->release();
    for (auto& [shape, pass] : _parts->constraintPasses)
        pass->release();
    for (FeedbackPass* pass : {_parts->localPass.get(), _parts->worldPass.get()})
        if (pass) pass->release();
    _parts->scratch.release();
    _parts->mixedTracks.release();
    _parts->solved.release();
    _parts->corrections.release();
    _parts->vertexArrays.release();
    discardAllGLObjects();
}

void PosePipeline::discardAllGLObjects()
{
    _parts->sets.clear();
    _parts->posePasses.clear();
    _parts->mixPasses.clear();
    _parts->constraintPasses.clear();
    _parts->localPass.reset();
    _parts->worldPass.reset();
    _parts->scratch.discard();
    _parts->mixedTracks.discard();
    _parts->solved.discard();
    _parts->corrections.discard();
    _parts->vertexArrays.discard();
}

} // namespace osgGpuAnimation
