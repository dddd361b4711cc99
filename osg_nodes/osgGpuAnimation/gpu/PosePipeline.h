// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <osg/GLObjects>
#include <osg/State>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// Computes the palettes of pose batches on the GPU with transform feedback. Each graphics context has one pipeline,
/// from the first of() to the end of the context. Call it on the draw side only, with the context current.
///
///     PosePipeline* pipeline = PosePipeline::of(state);
///     pipeline->evaluate(state, batch, 0);
///     PalettePlace place = pipeline->place(batch.set(), 0, instance);
///
/// The fused form computes mix, local and world in one pass, with one draw per level of the hierarchy for all
/// instances. The separate form has one pass per stage: fewer draws, each of which waits for the one before, and more
/// work for an entry. So it serves small batches (see tests/benchmark/RESULTS.md). A batch with targets of constraints
/// takes the fused form: one more draw per constraint, and one per run of entries that they turn or not.
class PosePipeline : public osg::GraphicsObjectManager
{
public:
    /// The division of the stages into passes.
    enum class Form
    {
        Automatic, ///< the faster one for the levels and entries, see Options::entriesWorthADraw
        Fused,     ///< one pass, one draw per level
        Separate,  ///< mix, local, world: three draws; the world stage multiplies along the ancestors
        Cpu,       ///< no pass: the CPU twin computes the palettes and uploads them, slower
    };

    /// The fastest measured chunk size, by a small margin (tests/benchmark/RESULTS.md).
    static constexpr std::size_t usualChunkSize = 4096;

    /// The settings of a pipeline, for tests and benchmarks.
    struct Options
    {
        /// The division of the stages into passes. If transform feedback of the context writes nothing, all forms are
        /// Form::Cpu, as initially with OSGGPUANIMATION_POSES=cpu in the environment.
        Form form = Form::Automatic;
        /// How many palette entries of 8 levels take as much longer in the separate form as one draw does in the fused
        /// form. The initial value is that of a card or of a software renderer.
        std::size_t entriesWorthADraw = 0;
        /// The largest number of texels of a buffer texture: at most GL_MAX_TEXTURE_BUFFER_SIZE, the initial value, or
        /// OSGGPUANIMATION_MAX_TEXELS in the environment if that is less.
        std::size_t maxTexels = 0;
        /// False: draws for entries beyond the first rebind attributes, as OpenGL 3.3 needs. True, the initial value of
        /// OpenGL 4.2 or ARB_base_instance, only there.
        bool usesBaseInstances = false;
        bool drawsTriangles = true; ///< false: the fused form draws points
        /// The largest number of instances per draw, above 0; it limits the scratch buffer. A chunk has fewer
        /// instances if a buffer texture cannot hold them.
        std::size_t chunkSize = usualChunkSize;
    };

    /// Counts since the pipeline was created.
    struct Counters
    {
        std::uint64_t feedbackDraws = 0;      ///< draws of all passes
        std::uint64_t instancesEvaluated = 0; ///< palettes computed
        std::uint64_t bytesUploaded = 0;      ///< samples, root matrices, tints and posed keyframes, without the sets
    };

    /// Called by OSG; use of() instead.
    explicit PosePipeline(unsigned int contextId);

    /// The pipeline of the state's context; null, with one warning, if the context lacks OpenGL 3.3 with transform
    /// feedback.
    static PosePipeline* of(osg::State& state);

    /// Uploads the batch and computes its palette, unless it equals the last batch of the same set and slot. The slots
    /// 0, 1, 2 … distinguish batches of one set; the palette of a slot is valid until the next evaluate() of that slot.
    /// Returns false for a batch without a set. Returns false, with one warning, if the set is too large for the
    /// context's buffer textures or a pass does not compile: the batch then has no palette, and its characters are not
    /// drawn.
    bool evaluate(osg::State& state, const PoseBatch& batch, std::size_t slot);

    /// As evaluate(), with each form that later batches of this kind may take, so that these compile nothing.
    bool evaluateInEachForm(osg::State& state, const PoseBatch& batch, std::size_t slot);

    /// The largest number of poses of one sample that one chunk holds, so that one buffer texture has all of them.
    static std::size_t chunkCapacity(const AnimationSet& set, const Options& options);

    /// The palette of an instance of the last batch of this set and slot; its texture is 0 if there is none.
    PalettePlace place(const AnimationSet& set, std::size_t slot, std::size_t instance) const;

    /// The root matrix of an instance of the last batch of this set and slot; the identity if there is none.
    AffineMatrix rootMatrix(const AnimationSet& set, std::size_t slot, std::size_t instance) const;

    /// Reads the palette of an instance: set.paletteSize() entries, or none without a palette. It waits for the GPU:
    /// for tools and tests, not for frames.
    std::vector<AffineMatrix> readPalette(osg::State& state, const AnimationSet& set, std::size_t slot,
                                          std::size_t instance) const;

    /// The settings of the next evaluate().
    Options& options() { return _options; }
    /// Options::maxTexels: the largest number of texels of a buffer texture.
    std::size_t getMaxTexels() const { return _options.maxTexels; }
    /// The counts so far.
    const Counters& getCounters() const { return _counters; }

    void flushDeletedGLObjects(double currentTime, double& availableTime) override;
    void flushAllDeletedGLObjects() override;
    void deleteAllGLObjects() override;
    void discardAllGLObjects() override;

protected:
    ~PosePipeline() override;

private:
    struct Parts;

    Options _options;
    bool _isSupported = false;
    Counters _counters;
    std::unique_ptr<Parts> _parts; ///< the passes and buffers of this context
};

} // namespace osgGpuAnimation
