// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/buffers/AnimationBuffers.h>
#include <osgGpuAnimation/gpu/buffers/PosePalette.h>
#include <osgGpuAnimation/gpu/detail/Renderer.h>
#include <osgGpuAnimation/gpu/passes/FusedEvaluation.h>

#include <layout.glsl>

#include <osg/ContextData>
#include <osg/Notify>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>
#include <optional>
#include <string>

namespace osgGpuAnimation
{

namespace
{

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

/// The number of rotations that the constraints of a set may correct.
std::size_t correctionsOf(const AnimationSet& set)
{
    std::size_t count = 0;
    for (const ConstraintChain& chain : set.constraintChains())
        count += chain.joints.size();
    return count;
}

/// The number of matrices of an instance that the separate form writes in its largest pass.
std::size_t widestPassOf(const AnimationSet& set)
{
    return std::max(set.paletteSize(), set.trackCount());
}

constexpr std::size_t separateDraws = 3;
constexpr std::size_t measuredLevels = 8; ///< of entriesWorthADraw(); an entry of the separate form walks to the root

/// Measured with sets of 50 joints in 8 and 16 levels. NVIDIA H200: separate 73 and 75 µs and 16 ns a joint, fused 200
/// and 330 µs and 7 ns. llvmpipe: 9 µs and 100 ns, 21 µs and 30 ns.
std::size_t entriesWorthADraw()
{
    return isSoftwareRenderer() ? 32 : 2560;
}

/// Texels of a buffer texture.
std::size_t maxTexelsOfContext()
{
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
    constexpr GLint leastOfAll = 65536; // OpenGL 3.3, table 6.43
    const char* wanted = std::getenv("OSGGPUANIMATION_MAX_TEXELS");
    if (wanted) limit = std::min(limit, std::max(std::atoi(wanted), leastOfAll));
    return static_cast<std::size_t>(std::max(limit, 0));
}

/// The separate form: mix, local, world, one draw each; the world stage multiplies along the ancestors. It is the
/// readable form of the stages, without constraints. False: a pass does not compile.
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

/// The CPU twin in place of all passes: computes the palettes of the chunk's instances and uploads them. memory: kept
/// from call to call.
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

} // namespace

struct PosePipeline::Parts
{
    Parts(const Options& options, osg::GLExtensions& gl) : options(options), context(gl) {}

    void forgetUnusedSets();
    std::size_t chunkCapacity(const PoseBatch& batch) const;
    bool hasRoomForMasks(SetResources& resources, const PoseBatch& batch) const;
    bool isOnCpu(osg::State& state);
    bool isSeparate(const PoseBatch& batch, const std::vector<PosePalette::Chunk*>& chunks) const;
    bool mayBeSeparate(const AnimationSet& set, std::size_t instances) const;
    SetResources& resourcesOf(const PoseBatch& batch);
    const PosePalette* find(const AnimationSet& set, std::size_t slot) const;

    const Options& options;
    EvaluationContext context;
    std::map<const AnimationSet*, SetResources> sets;
    std::optional<bool> canWriteFeedback; ///< none: not tried yet
};

PosePipeline::PosePipeline(unsigned int contextId) : osg::GraphicsObjectManager("PosePipeline", contextId)
{
    osg::GLExtensions& gl = *osg::GLExtensions::Get(contextId, true);
    _parts = std::make_unique<Parts>(_options, gl);
    const char* const poses = std::getenv("OSGGPUANIMATION_POSES");
    if (poses && std::string(poses) == "cpu") _options.form = Form::Cpu;
    _options.maxTexels = maxTexelsOfContext();
    _options.usesBaseInstances = FeedbackPass::canOffsetInstances(gl);
    _options.entriesWorthADraw = entriesWorthADraw();
    _isSupported =
        gl.glVersion >= 3.3f && gl.glBeginTransformFeedback && gl.glTexBuffer && _parts->context.copyBufferSubData;
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
    if (std::max(keyframeTexels, entryTexels) <= options.maxTexels)
    {
        resources.buffers = std::make_unique<AnimationBuffers>(*context.gl, set, keyframes);
        return resources;
    }
    const auto isExact = [](const Clip& clip) { return !clip.compactTracks(); };
    const bool mayBeSmaller =
        entryTexels <= options.maxTexels && std::any_of(set.clips().begin(), set.clips().end(), isExact);
    OSG_WARN << "osgGpuAnimation: an animation set needs buffers of " << keyframeTexels << " texels (keyframes) and "
             << entryTexels << " (palette entries), this context takes at most " << options.maxTexels
             << "; its characters are not drawn"
             << (mayBeSmaller ? "; the option compact=1e-4, or compactClips(), makes the keyframes smaller" : "")
             << std::endl;
    return resources;
}

bool PosePipeline::evaluate(osg::State& state, const PoseBatch& batch, std::size_t slot)
{
    _parts->forgetUnusedSets();
    if (!batch.sharedSet()) return false;
    SetResources& resources = _parts->resourcesOf(batch);
    if (!resources.buffers) return false;
    while (resources.palettes.size() <= slot)
        resources.palettes.push_back(std::make_unique<PosePalette>(*_parts->context.gl));

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

    EvaluationContext& context = _parts->context;
    context.drawsTriangles = _options.drawsTriangles;
    context.usesBaseInstances = _options.usesBaseInstances;
    if (_parts->isOnCpu(state))
    {
        for (PosePalette::Chunk* chunk : changed)
        {
            evaluateOnCpu(batch, *chunk, context.onCpu);
            chunk->isEvaluated = true;
            _counters.instancesEvaluated += chunk->size;
        }
        return true;
    }
    FeedbackVertexArrays::Names& vertexArrays = context.vertexArrays.of(state);
    const bool isSeparate = _parts->isSeparate(batch, changed);
    FeedbackScope scope(state, isSeparate ? vertexArrays.empty : vertexArrays.pose);
    for (PosePalette::Chunk* chunk : changed)
    {
        chunk->palette.reserve(set.paletteSize() * chunk->width * EvaluationContext::matrixBytes);
        chunk->isEvaluated =
            isSeparate ? evaluateSeparately(context, scope, batch, *resources.buffers, *chunk)
                       : FusedEvaluation(context, scope, vertexArrays, batch, *resources.buffers, *chunk).run();
        _counters.feedbackDraws = context.draws;
        if (!chunk->isEvaluated) return false;
        _counters.instancesEvaluated += chunk->size;
    }
    return true;
}

bool PosePipeline::evaluateInEachForm(osg::State& state, const PoseBatch& batch, std::size_t slot)
{
    if (_options.form != Form::Automatic || batch.needs().constraints != 0) return evaluate(state, batch, slot);
    _options.form = Form::Fused;
    bool isEvaluated = evaluate(state, batch, slot);
    if (isEvaluated && _parts->mayBeSeparate(batch.set(), PosePalette::widthOf(batch.size())))
    {
        _parts->sets.at(&batch.set()).palettes[slot]->invalidate();
        _options.form = Form::Separate;
        isEvaluated = evaluate(state, batch, slot);
    }
    _options.form = Form::Automatic;
    return isEvaluated;
}

/// True if the CPU computes the palettes. Tries feedback once, before the first pass.
bool PosePipeline::Parts::isOnCpu(osg::State& state)
{
    if (options.form == Form::Cpu) return true;
    if (!canWriteFeedback)
    {
        const FeedbackScope scope(state, context.vertexArrays.of(state).empty);
        canWriteFeedback = FeedbackPass::canWrite(*context.gl);
        if (!*canWriteFeedback)
            OSG_WARN << "osgGpuAnimation: transform feedback of " << rendererName()
                     << " does not write what shaders compute, so the CPU computes all poses, which is slower"
                     << std::endl;
    }
    return !*canWriteFeedback;
}

/// True if the separate form has fewer draws, and its buffers have room for so many instances.
bool PosePipeline::Parts::mayBeSeparate(const AnimationSet& set, std::size_t instances) const
{
    return set.levelCount() > separateDraws &&
           POSE_TEXELS_PER_MATRIX * widestPassOf(set) * instances <= options.maxTexels;
}

bool PosePipeline::Parts::isSeparate(const PoseBatch& batch, const std::vector<PosePalette::Chunk*>& chunks) const
{
    if (batch.needs().constraints != 0 || options.form == Form::Fused) return false;
    if (options.form == Form::Separate) return true;
    const AnimationSet& set = batch.set();
    const std::size_t instances =
        std::accumulate(chunks.begin(), chunks.end(), std::size_t(0),
                        [](std::size_t sum, const auto* chunk) { return sum + chunk->width; });
    if (!mayBeSeparate(set, instances)) return false;
    const std::size_t levels = set.levelCount();
    return widestPassOf(set) * instances * levels <=
           (levels - separateDraws) * options.entriesWorthADraw * measuredLevels;
}

std::size_t PosePipeline::chunkCapacity(const AnimationSet& set, const Options& options)
{
    const std::size_t widest = options.form == Form::Separate ? widestPassOf(set) : set.paletteSize();
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
    Options limited = options;
    const std::size_t texels = std::max(PosePalette::posedTexels(batch), batch.sampleStride());
    limited.chunkSize = std::min(options.chunkSize, options.maxTexels / texels);
    return PosePipeline::chunkCapacity(batch.set(), limited);
}

bool PosePipeline::Parts::hasRoomForMasks(SetResources& resources, const PoseBatch& batch) const
{
    const std::size_t texels = AnimationBuffers::texelsPerMask(batch.set()) * batch.masks().size();
    if (texels <= options.maxTexels) return true;
    if (!resources.isMaskLimitReported)
        OSG_WARN << "osgGpuAnimation: the masks of an animation set need a buffer of " << texels
                 << " texels, this context takes at most " << options.maxTexels << "; its characters are not drawn"
                 << std::endl;
    resources.isMaskLimitReported = true;
    return false;
}

/// Null: there is none.
const PosePalette* PosePipeline::Parts::find(const AnimationSet& set, std::size_t slot) const
{
    const auto known = sets.find(&set);
    const bool isKnown = known != sets.end() && slot < known->second.palettes.size();
    return isKnown ? known->second.palettes[slot].get() : nullptr;
}

PalettePlace PosePipeline::place(const AnimationSet& set, std::size_t slot, std::size_t instance) const
{
    const PosePalette* palette = _parts->find(set, slot);
    return palette ? palette->place(instance) : PalettePlace();
}

AffineMatrix PosePipeline::rootMatrix(const AnimationSet& set, std::size_t slot, std::size_t instance) const
{
    const PosePalette* palette = _parts->find(set, slot);
    return palette ? palette->rootMatrix(instance) : AffineMatrix();
}

std::vector<AffineMatrix> PosePipeline::readPalette(osg::State& state, const AnimationSet& set, std::size_t slot,
                                                    std::size_t instance) const
{
    const PalettePlace where = place(set, slot, instance);
    std::vector<AffineMatrix> entries(where.texture == 0 ? 0 : set.paletteSize());
    if (entries.empty()) return entries;
    const PosePalette& palette = *_parts->find(set, slot);
    for (const std::unique_ptr<PosePalette::Chunk>& chunk : palette.chunks())
        if (chunk->palette.texture() == where.texture)
            _parts->context.gl->glBindBuffer(GL_TEXTURE_BUFFER, chunk->palette.buffer());
    constexpr std::size_t matrixBytes = EvaluationContext::matrixBytes;
    for (std::size_t entry = 0; entry < entries.size(); ++entry)
        _parts->context.gl->glGetBufferSubData(GL_TEXTURE_BUFFER,
                                               static_cast<GLintptr>((entry * static_cast<std::size_t>(where.stride) +
                                                                      static_cast<std::size_t>(where.instance)) *
                                                                     matrixBytes),
                                               matrixBytes, &entries[entry]);
    _parts->context.gl->glBindBuffer(GL_TEXTURE_BUFFER, 0);
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
    _parts->sets.clear();
    _parts->context.release();
}

void PosePipeline::discardAllGLObjects()
{
    _parts->sets.clear();
    _parts->context.discard();
}

} // namespace osgGpuAnimation
