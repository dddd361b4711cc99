// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// The GPU's side of one PoseBatch in one graphics context: its input buffers and the palette they become. Large
/// batches are cut into chunks, each small enough for a buffer texture.
class PosePalette
{
public:
    struct Chunk
    {
        explicit Chunk(osg::GLExtensions& gl);

        /// Whether the pose pass gets all samples as attributes; otherwise it fetches them.
        bool hasSamplesAsAttributes() const;
        /// Makes the instances the vertices of the pose pass.
        void bindInstances(osg::GLExtensions& gl) const;

        std::size_t size = 0;  ///< instances
        std::size_t width = 0; ///< widthOf(size): the palette's stride
        std::size_t sampleStride = 1;
        std::vector<BlendSample> uploadedSamples;       ///< what `samples` holds
        std::vector<AffineMatrix> uploadedRootMatrices; ///< what `roots` holds
        std::vector<std::uint32_t> uploadedTints;       ///< what `tints` holds
        BufferTexture samples;
        BufferTexture roots;
        BufferTexture tints;
        bool isEvaluated = false; ///< `palette` is what the inputs ask for
        BufferTexture palette;    ///< RGBA32F: paletteSize * width matrices, entry-major
    };

    /// Places of so many instances: filled up to what the feedback pass draws the fastest way. Those beyond are
    /// computed from whatever lies in the buffers, whose numbers a fetch out of range at most makes other numbers, and
    /// never read.
    static std::size_t widthOf(std::size_t size);

    explicit PosePalette(osg::GLExtensions& gl) : _gl(&gl) {}

    /// Cuts the batch's instances into chunks of at most that many and uploads what is new of each.
    /// Returns the chunks that are to be evaluated: those whose content changed, and those that have not been yet.
    /// bytesUploaded is added to.
    std::vector<Chunk*> upload(const PoseBatch& batch, std::size_t chunkCapacity, std::size_t& bytesUploaded);

    /// No texture where the instance's chunk has not been evaluated.
    PalettePlace place(std::size_t instance) const;
    /// No chunk counts as evaluated any more.
    void invalidate();
    const std::vector<std::unique_ptr<Chunk>>& chunks() const { return _chunks; }

    void release();
    void discard();

private:
    osg::GLExtensions* _gl;
    std::size_t _chunkCapacity = 1;
    std::vector<std::unique_ptr<Chunk>> _chunks;
};

} // namespace osgGpuAnimation
