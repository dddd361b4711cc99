// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
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

        /// True if the pose pass gets all samples as attributes; otherwise it fetches them.
        bool hasSamplesAsAttributes() const;
        /// Binds the instances as the vertices of the pose pass, in its vertex array object.
        void bindInstances(osg::GLExtensions& gl, FeedbackVertexArrays::Names& arrays) const;

        std::size_t size = 0;  ///< instances
        std::size_t width = 0; ///< widthOf(size): the palette's stride
        std::size_t sampleStride = 1;
        std::vector<BlendSample> uploadedSamples;       ///< content of `samples`
        std::vector<AffineMatrix> uploadedRootMatrices; ///< content of `roots`; a single one: for all instances
        std::vector<std::uint32_t> uploadedTints;       ///< content of `tints`
        std::vector<std::uint64_t> uploadedPosed;       ///< the serials of the content of `posed`
        std::size_t firstPosed = 0;                     ///< the keyframe of the batch that is the first of `posed`
        std::vector<ConstraintTarget> uploadedTargets;  ///< content of `targets`
        BufferTexture samples;
        BufferTexture roots;
        BufferTexture tints;
        BufferTexture posed; ///< RGBA32UI: the posed keyframes of the chunk's instances
        BufferTexture targets;
        bool isEvaluated = false; ///< true if `palette` belongs to the inputs
        BufferTexture palette;    ///< RGBA32F: paletteSize * width matrices, entry-major
    };

    /// The number of instances rounded up to the multiple that the feedback pass draws fastest. Padding instances
    /// contain undefined values and are never read.
    static std::size_t widthOf(std::size_t size);

    explicit PosePalette(osg::GLExtensions& gl) : _gl(&gl) {}

    /// Splits the batch into chunks of at most chunkCapacity instances and uploads the changes of each chunk. Returns
    /// the chunks to evaluate: those with changes and those never evaluated. Adds to bytesUploaded.
    std::vector<Chunk*> upload(const PoseBatch& batch, std::size_t chunkCapacity, std::size_t& bytesUploaded);

    /// The texture is 0 if the instance's chunk has not been evaluated.
    PalettePlace place(std::size_t instance) const;
    /// The instance's root matrix; the identity without one.
    AffineMatrix rootMatrix(std::size_t instance) const;
    /// Marks all chunks as not evaluated.
    void invalidate();
    /// The texels that the posed keyframes of one instance take.
    static std::size_t posedTexels(const PoseBatch& batch);
    const std::vector<std::unique_ptr<Chunk>>& chunks() const { return _chunks; }

    void release();

private:
    bool uploadPosed(const PoseBatch& batch, std::size_t first, Chunk& chunk, std::size_t& bytesUploaded);

    osg::GLExtensions* _gl;
    std::vector<glm::uvec4> _posedTexels; ///< memory of uploadPosed()
    std::size_t _chunkCapacity = 1;
    std::vector<std::unique_ptr<Chunk>> _chunks;
    std::vector<std::weak_ptr<const SetMask>> _masks; ///< of the last batch, by number
};

} // namespace osgGpuAnimation
