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

/// Turns pose batches into palettes on the GPU, by transform feedback: one object a graphics context, made at first
/// use and living with the context. Only to be called on the draw side, with the context current.
///
///     PosePipeline* pipeline = PosePipeline::of(state);
///     pipeline->evaluate(state, batch, 0);
///     PalettePlace place = pipeline->place(batch.set(), 0, instance);
///
/// The default form computes mix, local and world in one pass, a draw a level of the hierarchy for all instances (see
/// tests/benchmark/RESULTS.md); the separate form has a pass for each stage.
class PosePipeline : public osg::GraphicsObjectManager
{
public:
    enum class Form
    {
        Fused,    ///< one pass, a draw a level
        Separate, ///< mix, local, world: three draws, the world stage walking up the ancestors
    };

    /// Counted since the pipeline was made.
    struct Counters
    {
        std::uint64_t feedbackDraws = 0;
        std::uint64_t instancesEvaluated = 0;
        std::uint64_t bytesUploaded = 0; ///< a frame's instructions and root matrices, not the sets
    };

    explicit PosePipeline(unsigned int contextId);

    /// The context's own; null, with one warning, where the context lacks OpenGL 3.3's transform feedback.
    static PosePipeline* of(osg::State& state);

    /// Uploads the batch and computes its palette, unless nothing changed since the last batch of the same set and
    /// slot. Slots tell batches of one set apart: 0, 1, 2 …; a slot's palette lasts until its next evaluate.
    /// False, with one warning, where the set is too large for the context's buffer textures or a pass does not
    /// compile: the batch then has no palette, and its characters are not drawn.
    bool evaluate(osg::State& state, const PoseBatch& batch, std::size_t slot);

    /// Where an instance of the batch last evaluated for set and slot is. No texture where there is none.
    PalettePlace place(const AnimationSet& set, std::size_t slot, std::size_t instance) const;

    /// For tools and tests, never in a frame: waits for the GPU. set.paletteSize() entries of the instance.
    std::vector<AffineMatrix> readPalette(osg::State& state, const AnimationSet& set, std::size_t slot,
                                          std::size_t instance) const;

    void setForm(Form form) { _form = form; }
    Form getForm() const { return _form; }
    /// Texels a buffer texture may have; GL_MAX_TEXTURE_BUFFER_SIZE unless set smaller (tests).
    void setMaxTexels(std::size_t texels) { _maxTexels = texels; }
    std::size_t getMaxTexels() const { return _maxTexels; }
    /// Instances that are evaluated at a time, at most; fewer where a buffer texture takes no more. Above 0. The usual
    /// size is the fastest one measured, by little (tests/benchmark/RESULTS.md), and bounds the scratch buffer.
    static constexpr std::size_t usualChunkSize = 4096;
    void setChunkSize(std::size_t instances) { _chunkSize = instances; }
    const Counters& getCounters() const { return _counters; }

    void flushDeletedGLObjects(double currentTime, double& availableTime) override;
    void flushAllDeletedGLObjects() override;
    void deleteAllGLObjects() override;
    void discardAllGLObjects() override;

protected:
    ~PosePipeline() override;

private:
    struct Parts;

    Form _form = Form::Fused;
    std::size_t _maxTexels = 0;
    std::size_t _chunkSize = usualChunkSize;
    bool _isSupported = false;
    Counters _counters;
    std::unique_ptr<Parts> _parts; ///< the passes and buffers of this context
};

} // namespace osgGpuAnimation
